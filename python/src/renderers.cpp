// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "images.h"
#include "pellucid/cpu/renderer.h"
#include "pellucid/reference/render.h"
#include "render/relative_tolerance.h"
#include "scenes.h"
#include "waiting.h"

namespace pellucid::python {

int checked_threads(int threads) {
  constexpr int most = 1024;
  if (threads >= 0 && threads <= most) return threads;
  throw Error("threads: expected 0 (one per core) to " + std::to_string(most) + ", got " +
              std::to_string(threads));
}

namespace {

/// Python's Frame: a frame that is being rendered.
class FrameHandle {
 public:
  /// Holds a frame that runs. `image`: of the scene, without pixels.
  FrameHandle(RunningFrame frame, ImageHandle image)
      : frame_(std::make_unique<RunningFrame>(std::move(frame))), empty_(std::move(image)) {}
  FrameHandle(FrameHandle&&) = default;
  FrameHandle& operator=(FrameHandle&&) = default;
  ~FrameHandle() noexcept(false) {
    if (!frame_) return;
    // The frame's threads may let go of arrays, for which they need the interpreter's lock.
    const ReleasedLock released;
    frame_.reset();
  }

  /// Calls body(frame) without the interpreter's lock.
  template <class Body>
  auto with_frame(Body&& body) const {
    const ReleasedLock released;
    return body(*frame_);
  }

  ImageHandle wait(const py::object& progress) {
    if (image_) return *image_;
    if (waited_for_) throw Error("frame: another thread waits for it, or it was cancelled");
    waited_for_ = true;
    try {
      wait_until([&] { return frame_->finished(); }, [&] { return frame_->state().fraction; },
                 progress);
    } catch (...) {
      const ReleasedLock released;
      frame_->cancel();
      while (!frame_->finished()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      throw;
    }
    ImageHandle handle = empty_;
    {
      const ReleasedLock released;
      RenderResult frame = frame_->wait();
      handle.image = std::make_shared<const Image>(std::move(frame.image));
      handle.report = std::move(frame.report);
    }
    image_ = handle;
    if (!progress.is_none()) progress(1.0);
    return handle;
  }

  ImageHandle look() const {
    if (image_) return *image_;
    const ReleasedLock released;
    return {std::make_shared<const Image>(frame_->look()), empty_.background};
  }

 private:
  std::unique_ptr<RunningFrame> frame_;
  ImageHandle empty_;
  std::optional<ImageHandle> image_{};
  bool waited_for_ = false;
};

/// Lets go of what it kept without the interpreter's lock, as its threads may need it.
struct RendererHandle {
  explicit RendererHandle(int threads)
      : renderer(std::make_unique<Renderer>(checked_threads(threads))) {}
  ~RendererHandle() noexcept(false) {
    const ReleasedLock released;
    renderer.reset();
  }
  std::unique_ptr<Renderer> renderer;
};

RenderOptions options_of(const Scene& scene, bool depth, bool error, bool values, int threads,
                         int preview) {
  RenderOptions options;
  options.outputs.depth = depth;
  options.outputs.error = error && scene.integration.method == Method::exact;
  options.outputs.values = values;
  options.machine.threads = checked_threads(threads);
  options.monitor.preview = preview;
  return options;
}

FrameHandle start(RendererHandle& handle, const py::object& object, bool depth, bool error,
                  bool values, int threads, int preview) {
  if (preview < 0 || preview > largest_preview) {
    throw Error("preview: expected a number of levels from 0 to " +
                std::to_string(largest_preview) + ", got " + std::to_string(preview));
  }
  const PythonScene made = complete_python_scene(object);
  const Scene& scene = made.scene;
  RenderOptions options = options_of(scene, depth, error, values, threads, preview);
  ImageHandle image = image_of_scene(made.description, scene, shown_background(object));
  const ReleasedLock released;
  return {handle.renderer->start(scene, std::move(options)), std::move(image)};
}

ImageHandle render(RendererHandle& handle, const py::object& scene, bool depth, bool error,
                   bool values, int threads, const py::object& progress) {
  return start(handle, scene, depth, error, values, threads, 0).wait(progress);
}

/// Runs body() in a thread, without the interpreter's lock, and waits for it. Throws what it
/// throws, and what `progress` and signals raise, once `stop` has ended it.
template <class Body, class Fraction>
void in_a_thread(Body&& body, std::stop_source& stop, Fraction&& fraction,
                 const py::object& progress) {
  std::exception_ptr failure;
  std::atomic<bool> finished = false;
  std::jthread worker([&] {
    try {
      body();
    } catch (...) {
      failure = std::current_exception();
    }
    finished = true;
  });
  const auto join = [&] {
    const ReleasedLock released;
    worker.join();
  };
  try {
    wait_until([&] { return finished.load(); }, fraction, progress);
  } catch (...) {
    stop.request_stop();
    join();
    throw;
  }
  join();
  if (failure) std::rethrow_exception(failure);
}

/// Renders at the tolerance that is `share` of the picture's largest channel. Several frames are
/// rendered: a thread does it, and asks between them and within whether to stop.
ImageHandle render_share(RendererHandle& handle, const py::object& object, double share, bool depth,
                         bool error, bool values, int threads, const py::object& progress) {
  PythonScene made = complete_python_scene(object);
  if (!(share > 0 && share <= 1))
    throw Error("tolerance: a share must be above 0 % and at most 100 %");
  if (made.scene.integration.method != Method::exact) {
    throw Error("tolerance: a share is for the method exact, not for " +
                std::string(method_name(made.scene.integration.method)));
  }
  RenderOptions options = options_of(made.scene, depth, error, values, threads, 0);
  std::stop_source stop;
  options.monitor.stop = stop.get_token();
  std::atomic<double> fraction = 0;
  bool estimates = true;
  // How many frames it takes is not known: the last tenth waits for the last one.
  options.monitor.progress = [&](double done) {
    if (!estimates) fraction = std::max(fraction.load(), 0.9 * done);
    return !stop.stop_requested();
  };
  ImageHandle result;
  const std::optional<Background> background = shown_background(object);
  std::optional<std::string> over;
  in_a_thread(
      [&] {
        const double range = cli::estimate_range(made.scene, options.machine, options.monitor);
        estimates = false;
        cli::RelativePicture picture = cli::render_relative(share, range, [&](double tolerance) {
          made.scene.integration.tolerance = nearest_tolerance(tolerance);
          fit_opacity_tables(made.description, made.scene);
          return handle.renderer->render(made.scene, options);
        });
        result = image_of_scene(made.description, made.scene, background);
        result.image = std::make_shared<const Image>(std::move(picture.image));
        result.report = picture.report;
        over = picture.over;
      },
      stop, [&] { return fraction.load(); }, progress);
  if (!progress.is_none()) progress(1.0);
  if (over) {
    Notes notes;
    notes(*over);
    notes.warn();
  }
  return result;
}

/// Renders by the reference, which has no frame to watch: it asks Python itself, from one of its
/// threads.
ImageHandle reference_image(const py::object& object, bool depth, int threads,
                            const py::object& progress) {
  const PythonScene made = complete_python_scene(object);
  const Scene& scene = made.scene;
  RenderOptions options;
  options.outputs.depth = depth;
  options.machine.threads = checked_threads(threads);
  std::atomic<double> fraction = 0;
  std::stop_source stop;
  options.monitor.stop = stop.get_token();
  options.monitor.progress = [&](double done) {
    fraction = done;
    return !stop.stop_requested();
  };
  ImageHandle handle = image_of_scene(made.description, scene, shown_background(object));
  handle.tolerance = 0;
  handle.accuracy.is_reference = true;
  in_a_thread(
      [&] {
        RenderResult frame = render_reference(scene, options);
        handle.image = std::make_shared<const Image>(std::move(frame.image));
        handle.report = std::move(frame.report);
      },
      stop, [&] { return fraction.load(); }, progress);
  return handle;
}

}  // namespace

void bind_renderers(py::module_& module) {
  py::class_<FrameHandle>(module, "Frame", R"(
A frame that is being rendered; Renderer.start() makes it. Letting go of it cancels it.)")
      .def("wait", &FrameHandle::wait, py::arg("progress") = py::none(), R"(
Waits for the image and returns it. `progress` is called with the finished fraction, every 20 ms;
what it raises cancels the frame and is raised here, and so is Ctrl-C. Raises Cancelled after
cancel(), and Error if the scene fails its checks.)")
      .def("look", &FrameHandle::look, R"(
Returns what is known of the image: a pixel that is not rendered yet has the color of its nearest
coarser one, or nothing. Without depth and error until wait() returned.)")
      .def(
          "cancel",
          [](const FrameHandle& handle) {
            handle.with_frame([](RunningFrame& frame) { frame.cancel(); });
          },
          "Asks the threads to stop, and returns at once.")
      .def_property_readonly(
          "finished",
          [](const FrameHandle& handle) {
            return handle.with_frame([](RunningFrame& frame) { return frame.finished(); });
          })
      .def_property_readonly(
          "fraction",
          [](const FrameHandle& handle) {
            return handle.with_frame([](RunningFrame& frame) { return frame.state().fraction; });
          },
          "Finished fraction of the pixels.")
      .def_property_readonly(
          "level",
          [](const FrameHandle& handle) {
            return handle.with_frame([](RunningFrame& frame) { return frame.state().level; });
          },
          R"(
The finest complete level of the preview: level n has every 2^n-th pixel along each axis, 0 is the
image, -1 none yet.)");

  py::class_<RendererHandle>(module, "Renderer", R"(
Renders frame after frame, and keeps what they share.

    Renderer(threads=0)     0: one per core

A camera that moves costs no set-up, a new transfer function its own. What is shared is found by
the identity of data and functions: pass the same objects again. Safe to use from any thread.)")
      .def(py::init<int>(), py::arg("threads") = 0)
      .def("render", &render, py::arg("scene"), py::kw_only(), py::arg("depth") = false,
           py::arg("error") = true, py::arg("values") = false, py::arg("threads") = 0,
           py::arg("progress") = py::none(), R"(
Renders a Scene and returns its Image.

depth, error and values fill the image's maps; values need one projected layer. `progress` is
called with the finished fraction, every 20 ms; what it raises cancels the frame and is raised
here, and so is Ctrl-C. Raises Error: one line that says what is wrong, where, and what to do.)")
      .def("render_to_share", &render_share, py::arg("scene"), py::arg("share"), py::kw_only(),
           py::arg("depth") = false, py::arg("error") = true, py::arg("values") = false,
           py::arg("threads") = 0, py::arg("progress") = py::none(), R"(
Renders a Scene at the tolerance that is `share` (in (0, 1]) of the picture's largest channel, and
returns its Image, whose tolerance that is. Renders small pictures first, to find the channel. Else
as render(). Warns if the picture may be off by more than the share.)")
      .def("start", &start, py::arg("scene"), py::kw_only(), py::arg("depth") = false,
           py::arg("error") = true, py::arg("values") = false, py::arg("threads") = 0,
           py::arg("preview") = 0, R"(
Starts a frame and returns it at once. preview = n renders every 2^n-th pixel along each axis
first, then those half-way between; the image is the same.)")
      .def(
          "clear",
          [](RendererHandle& handle) {
            const ReleasedLock released;
            handle.renderer->clear();
          },
          "Lets go of all that is kept.");

  module.def("render_reference", &reference_image, py::arg("scene"), py::kw_only(),
             py::arg("depth") = false, py::arg("threads") = 0, py::arg("progress") = py::none(), R"(
Renders a Scene by quadrature in double to 1e-12, with code of its own. Slow: minutes for what
takes a second. For tests of a renderer.)");
}

}  // namespace pellucid::python
