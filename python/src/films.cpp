// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>
#include <utility>

#include "images.h"
#include "pellucid/cpu/threads.h"
#include "pellucid/io/film.h"
#include "pellucid/io/film_files.h"
#include "scenes.h"
#include "waiting.h"

namespace pellucid::python {

namespace {

/// Has steps in time, which a scene's data have been read at one of, found again.
void forget_times(SceneDescription& scene) {
  for (LayerDescription& layer : scene.layers) {
    visit_sources(layer, [](FieldSource& field) { field.options.time.reset(); });
    if (layer.mesh) layer.mesh->options.time.reset();
  }
}

/// Returns whether Ctrl-C was pressed, of which Python then keeps the exception. Needs no lock of
/// Python.
bool is_interrupted() {
  wait_for_the_end_if_it_has_come();
  const py::gil_scoped_acquire acquired;
  return PyErr_CheckSignals() != 0;
}

/// The scenes of a film, for one thread at a time.
class FilmScenes {
 public:
  FilmScenes(const py::object& object, const std::string& animation) {
    PythonScene made = complete_python_scene(object);
    SceneDescription complete = described(made);
    complete.camera = made.scene.camera;
    const auto wanted =
        animation.empty() ? std::nullopt : std::optional(parse_animation(animation, "animation"));
    const ReleasedLock released;
    SceneDescription timed = complete;
    if (wanted && wanted->moves_data()) forget_times(timed);
    SceneTimes times(timed);
    film_ = std::make_unique<Film>(timed, timed, wanted ? *wanted : default_animation(times),
                                   std::move(times));
    loader_ = std::make_unique<FrameLoader>(complete, made.scene);
    backdrop_ = made.scene.backdrop;
  }

  int frames() const { return film_->frames(); }

  /// Checks every frame. Ctrl-C ends it.
  void check() const {
    bool is_done = false;
    {
      const ReleasedLock released;
      is_done = film_->check(is_interrupted);
    }
    if (!is_done && PyErr_Occurred() != nullptr) throw py::error_already_set();
  }

  /// Returns the scene of a frame, and as text what it is made from; none for arrays.
  py::tuple frame(int index) {
    if (index < 0 || index >= frames()) throw py::index_error("frame " + std::to_string(index));
    Scene scene;
    SceneDescription description;
    std::string made_from;
    {
      const ReleasedLock released;
      description = film_->description(index);
      scene = loader_->load(description, parallel_for(default_thread_count()));
      scene.backdrop = backdrop_;
      if (are_files(description)) made_from = data_stamp(description) + scene_to_json(description);
    }
    return py::make_tuple(to_python(scene, description), made_from);
  }

 private:
  static bool are_files(const SceneDescription& description) {
    try {
      check_has_sources(description);
    } catch (const Error&) {
      return false;
    }
    return true;
  }

  std::unique_ptr<Film> film_;
  std::unique_ptr<FrameLoader> loader_;
  std::shared_ptr<const Image> backdrop_;
};

}  // namespace

void bind_films(py::module_& module) {
  py::class_<FilmScenes>(module, "_FilmScenes")
      .def(py::init<const py::object&, const std::string&>(), py::arg("scene"),
           py::arg("animation"))
      .def("__len__", &FilmScenes::frames)
      .def("check", &FilmScenes::check)
      .def("frame", &FilmScenes::frame, py::arg("index"));
  py::class_<FilmFiles>(module, "_FilmFiles")
      .def(py::init<std::filesystem::path>(), py::arg("path"))
      .def_property_readonly("is_video", &FilmFiles::is_video)
      .def("picture", &FilmFiles::picture, py::arg("frame"))
      .def(
          "check_size",
          [](const FilmFiles& files, int width, int height) {
            const ReleasedLock released;
            files.check_size({width, height});
          },
          py::arg("width"), py::arg("height"))
      .def("hold", [](FilmFiles& files) { files.hold(FilmFiles::Holder::alone); })
      .def("release", &FilmFiles::release)
      .def("has", &FilmFiles::has, py::arg("frame"), py::arg("made_from"))
      .def(
          "write",
          [](const FilmFiles& files, int frame, const ImageHandle& image,
             const std::string& made_from) {
            const ReleasedLock released;
            files.write(frame, *image.image, made_from, image.background);
          },
          py::arg("frame"), py::arg("image"), py::arg("made_from"))
      .def(
          "finish",
          [](const FilmFiles& files, int frames, double fps, bool keeps_pictures) {
            bool is_made = false;
            {
              // Ctrl-C ends FFmpeg.
              const ReleasedLock released;
              is_made = files.finish(frames, fps, keeps_pictures, is_interrupted);
            }
            if (!is_made && PyErr_Occurred() != nullptr) throw py::error_already_set();
          },
          py::arg("frames"), py::arg("fps"), py::arg("keeps_pictures"));
}

}  // namespace pellucid::python
