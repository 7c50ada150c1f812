// SPDX-License-Identifier: Apache-2.0
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "pellucid/io/embed_scene.h"
#include "scenes.h"
#include "view/viewer.h"
#include "waiting.h"

namespace pellucid::python {

namespace {

/// Gives volumes in memory that have no name one that the page can show.
void name_arrays(PythonScene& made) {
  for (std::size_t i = 0; i < made.scene.layers.size(); ++i) {
    Layer& layer = made.scene.layers[i];
    const auto* const volume = std::get_if<VolumeContent>(&layer.content);
    if (volume == nullptr || !layer.name.empty()) continue;
    if (!has_source(made.description.layers[i].field)) {
      layer.name = volume->volume->description().name;
    }
  }
}

/// Returns a page that holds the scene.
py::bytes page_of_scene(const py::object& object, std::uint64_t most_bytes) {
  PythonScene made = complete_python_scene(object);
  name_arrays(made);
  SceneDescription description = described(made);
  description.camera = made.scene.camera;
  std::string page;
  {
    const ReleasedLock released;
    page = page_of(embed_scene(description, made.scene, most_bytes));
  }
  return py::bytes(page);
}

/// Returns a page of so many bytes at most, if its data can be made so coarse, and what it tells of
/// them.
py::tuple reduced_page_of_scene(const py::object& object, std::uint64_t most_bytes) {
  PythonScene made = complete_python_scene(object);
  name_arrays(made);
  SceneDescription description = described(made);
  description.camera = made.scene.camera;
  ReducedPage reduced;
  {
    const ReleasedLock released;
    reduced = reduced_page(description, made.scene, most_bytes);
  }
  return py::make_tuple(py::bytes(reduced.page), reduced.note);
}

/// Python's viewer of a scene: a server, and a thread that renders for its pages.
class ViewerHandle {
 public:
  ViewerHandle(const py::object& object, int port, int threads, const std::string& frame_ancestors)
      : shared_(std::make_shared<Shared>()), server_(shared_) {
    if (port < 0 || port > 65535) {
      throw Error("port: expected 0 (any free one) to 65535, got " + std::to_string(port));
    }
    PythonScene made = complete_python_scene(object);
    if (made.scene.backdrop) {
      throw Error("backdrop: the viewer shows scenes without one; remove it");
    }
    name_arrays(made);
    SceneDescription description = described(made);
    description.camera = made.scene.camera;
    scene_to_json(description);  // throws what cannot be told to a page
    shared_->description = description;
    shared_->scene = made.scene;
    given_ = made.scene.layers;
    view::ViewerOptions options;
    options.port = static_cast<std::uint16_t>(port);
    options.threads = checked_threads(threads);
    options.frame_ancestors = frame_ancestors;
    options.changed = [shared = shared_](const SceneDescription& changed, const Scene& scene) {
      SceneDescription new_description = changed;
      Scene new_scene = scene;
      const std::lock_guard lock(shared->mutex);
      std::swap(shared->description, new_description);
      std::swap(shared->scene, new_scene);
    };
    const ReleasedLock released;
    server_.thread = std::thread(
        [shared = shared_,
         scene = view::ViewedScene{std::move(description), std::move(made.scene), made.has_camera},
         options]() mutable { serve(*shared, std::move(scene), options); });
    std::unique_lock lock(shared_->mutex);
    shared_->wakes.wait(lock, [&] { return shared_->ended || !shared_->address.empty(); });
    if (!shared_->failure) return;
    lock.unlock();
    server_.end();
    std::rethrow_exception(shared_->failure);
  }
  ViewerHandle(const ViewerHandle&) = delete;
  ViewerHandle& operator=(const ViewerHandle&) = delete;
  ~ViewerHandle() noexcept(false) { stop(); }

  std::string address() const {
    const std::lock_guard lock(shared_->mutex);
    return shared_->address;
  }

  bool is_running() const {
    const std::lock_guard lock(shared_->mutex);
    return !shared_->ended;
  }

  void wait() const {
    wait_until([&] { return !is_running(); }, [] { return 0.0; }, py::none());
  }

  /// Stops the server. Its threads may let go of arrays, for which they need the interpreter's
  /// lock.
  void stop() {
    const ReleasedLock released;
    server_.end();
  }

  /// Returns whether each layer still has the data that it was given.
  std::vector<bool> same_data() const {
    const std::lock_guard lock(shared_->mutex);
    std::vector<bool> same;
    for (std::size_t i = 0; i < given_.size(); ++i) {
      same.push_back(data_of(given_[i]) == data_of(shared_->scene.layers[i]));
    }
    return same;
  }

  py::object scene() const {
    SceneDescription description;
    Scene scene;
    {
      const std::lock_guard lock(shared_->mutex);
      description = shared_->description;
      scene = shared_->scene;
    }
    return to_python(scene, description);
  }

 private:
  struct Shared {
    mutable std::mutex mutex;  ///< of all
    std::condition_variable wakes;
    std::string address;
    SceneDescription description;
    Scene scene;
    std::exception_ptr failure;
    bool stops = false, ended = false;
  };

  /// Ends its thread, also where a constructor is left.
  struct Server {
    explicit Server(std::shared_ptr<Shared> with) : shared(std::move(with)) {}
    ~Server() { end(); }
    void end() {
      {
        const std::lock_guard lock(shared->mutex);
        shared->stops = true;
      }
      const std::lock_guard lock(joins);
      if (thread.joinable()) thread.join();
    }
    std::shared_ptr<Shared> shared;
    std::thread thread{};
    std::mutex joins{};
  };

  /// Returns an address that identifies a layer's data.
  static const void* data_of(const Layer& layer) {
    return std::visit(
        [](const auto& content) -> const void* {
          using Content = std::decay_t<decltype(content)>;
          if constexpr (std::is_same_v<Content, VolumeContent>) return content.volume.get();
          if constexpr (std::is_same_v<Content, ChannelsContent>) return content.channels.get();
          if constexpr (std::is_same_v<Content, MeshContent>) return content.mesh.get();
          if constexpr (std::is_same_v<Content, LabelContent>) return content.labels.get();
          if constexpr (std::is_same_v<Content, SourceContent>) return content.source.get();
        },
        layer.content);
  }

  static void serve(Shared& shared, view::ViewedScene scene, const view::ViewerOptions& options) {
    std::exception_ptr failure;
    try {
      view::run_viewer(
          std::move(scene), options,
          [&](const std::string& address) {
            const std::lock_guard lock(shared.mutex);
            shared.address = address;
            shared.wakes.notify_all();
          },
          [&] {
            const std::lock_guard lock(shared.mutex);
            return shared.stops;
          });
    } catch (...) {
      failure = std::current_exception();
    }
    const std::lock_guard lock(shared.mutex);
    shared.failure = failure;
    shared.ended = true;
    shared.wakes.notify_all();
  }

  std::shared_ptr<Shared> shared_;
  std::vector<Layer> given_;
  Server server_;
};

}  // namespace

void bind_viewers(py::module_& module) {
  module.def("page_of_scene", page_of_scene, py::arg("scene"),
             py::arg("most_bytes") = std::numeric_limits<std::uint64_t>::max(),
             "The bytes of a page of HTML that holds the scene. Raises Error, also where its data "
             "have more bytes.");
  module.def(
      "page_without_scene", [] { return py::bytes(empty_page()); },
      "The bytes of a page of HTML that asks for a file. Raises Error.");
  module.def("reduced_page_of_scene", reduced_page_of_scene, py::arg("scene"),
             py::arg("most_bytes"),
             "A page likewise, with coarser data where it would have more bytes, and a line that "
             "says so.");
  py::class_<ViewerHandle>(module, "ViewerServer", "What pellucid.Viewer is made of.")
      .def(py::init<const py::object&, int, int, const std::string&>(), py::arg("scene"),
           py::arg("port"), py::arg("threads"), py::arg("frame_ancestors"))
      .def_property_readonly("address", &ViewerHandle::address)
      .def_property_readonly("running", &ViewerHandle::is_running)
      .def("scene", &ViewerHandle::scene)
      .def("same_data", &ViewerHandle::same_data)
      .def("wait", &ViewerHandle::wait)
      .def("stop", &ViewerHandle::stop);
}

}  // namespace pellucid::python
