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
#include "scenes.h"

namespace pellucid::python {

namespace {

using Clock = std::chrono::steady_clock;

/// Lets Python handle Ctrl-C, and tells `progress` how far a frame is. Throws what either raises.
void attend(const py::object& progress, double fraction) {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (!progress.is_none()) progress(fraction);
}

/// A thread that asks for the interpreter's lock while the interpreter ends would be ended by it,
/// which C++ does not survive. It waits for the end of the process here instead.
void wait_for_the_end_if_it_has_come() {
  while (_Py_IsFinalizing() != 0) std::this_thread::sleep_for(std::chrono::seconds(1));
}

/// Throws Error unless it is 0, one per core, or a number of threads that a machine can have.
int checked_threads(int threads) {
  constexpr int most = 1024;
  if (threads >= 0 && threads <= most) return threads;
  throw Error("threads: expected 0 (one per core) to " + std::to_string(most) + ", got " +
              std::to_string(threads));
}

/// Waits until `finished` returns true, without the interpreter's lock. Takes it every 20 ms for
/// signals and `progress`. Throws what these raise.
template <class Finished, class Fraction>
void wait_until(Finished&& finished, Fraction&& fraction, const py::object& progress) {
  using namespace std::chrono_literals;
  const Clock::time_point begin = Clock::now();
  Clock::time_point attended = begin;
  const py::gil_scoped_release released;
  while (!finished()) {
    const Clock::time_point now = Clock::now();
    if (now - attended >= 20ms) {
      attended = now;
      const double done = fraction();
      wait_for_the_end_if_it_has_come();
      const py::gil_scoped_acquire acquired;
      attend(progress, done);
    }
    // A tenth of the time that it took so far: short frames end at once, long ones cost no time.
    std::this_thread::sleep_for(std::clamp<Clock::duration>((now - begin) / 10, 20us, 1ms));
  }
  wait_for_the_end_if_it_has_come();
}

/// Python's Frame: a frame that is being rendered.
class FrameHandle {
 public:
  FrameHandle(RunningFrame frame, const Scene& scene)
      : frame_(std::make_unique<RunningFrame>(std::move(frame))),
        background_(scene.background),
        tolerance_(scene.integration.method == Method::exact ? scene.integration.tolerance : 0) {}
  FrameHandle(FrameHandle&&) = default;
  FrameHandle& operator=(FrameHandle&&) = default;
  ~FrameHandle() {
    if (!frame_) return;
    // The frame's threads may let go of arrays, for which they need the interpreter's lock.
    const py::gil_scoped_release released;
    frame_.reset();
  }

  /// Calls body(frame) without the interpreter's lock.
  template <class Body>
  auto with_frame(Body&& body) const {
    const py::gil_scoped_release released;
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
      const py::gil_scoped_release released;
      frame_->cancel();
      while (!frame_->finished()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      throw;
    }
    ImageHandle handle{nullptr, background_, tolerance_, {}};
    {
      const py::gil_scoped_release released;
      handle.image = std::make_shared<const Image>(frame_->wait(&handle.report));
    }
    image_ = handle;
    if (!progress.is_none()) progress(1.0);
    return handle;
  }

  ImageHandle look() const {
    if (image_) return *image_;
    const py::gil_scoped_release released;
    return {std::make_shared<const Image>(frame_->look()), background_};
  }

 private:
  std::unique_ptr<RunningFrame> frame_;
  std::optional<Rgb<double>> background_;
  double tolerance_;
  std::optional<ImageHandle> image_{};
  bool waited_for_ = false;
};

/// Lets go of what it kept without the interpreter's lock, as its threads may need it.
struct RendererHandle {
  explicit RendererHandle(int threads)
      : renderer(std::make_unique<Renderer>(checked_threads(threads))) {}
  ~RendererHandle() {
    const py::gil_scoped_release released;
    renderer.reset();
  }
  std::unique_ptr<Renderer> renderer;
};

RenderOptions options_of(const Scene& scene, bool depth, bool error, bool values, int threads,
                         int preview) {
  RenderOptions options;
  options.depth = depth;
  options.error = error && scene.integration.method == Method::exact;
  options.values = values;
  options.threads = checked_threads(threads);
  options.preview = preview;
  return options;
}

FrameHandle start(RendererHandle& handle, const py::object& object, bool depth, bool error,
                  bool values, int threads, int preview) {
  if (preview < 0 || preview > largest_preview) {
    throw Error("preview: expected a number of levels from 0 to " +
                std::to_string(largest_preview) + ", got " + std::to_string(preview));
  }
  Scene scene = complete_scene(object);
  RenderOptions options = options_of(scene, depth, error, values, threads, preview);
  const py::gil_scoped_release released;
  return {handle.renderer->start(scene, std::move(options)), scene};
}

ImageHandle render(RendererHandle& handle, const py::object& scene, bool depth, bool error,
                   bool values, int threads, const py::object& progress) {
  return start(handle, scene, depth, error, values, threads, 0).wait(progress);
}

/// The reference has no frame to watch: it asks Python itself, from one of its threads.
ImageHandle reference_image(const py::object& object, bool depth, int threads,
                            const py::object& progress) {
  const Scene scene = complete_scene(object);
  RenderOptions options;
  options.depth = depth;
  options.threads = checked_threads(threads);
  std::atomic<double> fraction = 0;
  std::stop_source stop;
  options.stop = stop.get_token();
  options.progress = [&](double done) {
    fraction = done;
    return !stop.stop_requested();
  };
  ImageHandle handle{nullptr, scene.background};
  std::exception_ptr failure;
  std::atomic<bool> finished = false;
  std::jthread worker([&] {
    try {
      handle.image =
          std::make_shared<const Image>(render_reference(scene, options, &handle.report));
    } catch (...) {
      failure = std::current_exception();
    }
    finished = true;
  });
  const auto join = [&] {
    const py::gil_scoped_release released;
    worker.join();
  };
  try {
    wait_until([&] { return finished.load(); }, [&] { return fraction.load(); }, progress);
  } catch (...) {
    stop.request_stop();
    join();
    throw;
  }
  join();
  if (failure) std::rethrow_exception(failure);
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
      .def("start", &start, py::arg("scene"), py::kw_only(), py::arg("depth") = false,
           py::arg("error") = true, py::arg("values") = false, py::arg("threads") = 0,
           py::arg("preview") = 0, R"(
Starts a frame and returns it at once. preview = n renders every 2^n-th pixel along each axis
first, then those half-way between; the image is the same.)")
      .def(
          "clear",
          [](RendererHandle& handle) {
            const py::gil_scoped_release released;
            handle.renderer->clear();
          },
          "Lets go of all that is kept.");

  module.def("render_reference", &reference_image, py::arg("scene"), py::kw_only(),
             py::arg("depth") = false, py::arg("threads") = 0, py::arg("progress") = py::none(), R"(
Renders a Scene by quadrature in double to 1e-12, with code of its own. Slow: minutes for what
takes a second. For tests of a renderer.)");
}

}  // namespace pellucid::python
