// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/look.h"

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "handles.h"
#include "images.h"
#include "pellucid/scene/defaults.h"
#include "pellucid/scene/picture_advice.h"
#include "scenes.h"

namespace pellucid::python {

namespace {

py::dict look_of(const py::object& data, const std::string& name, const py::object& colors,
                 const py::object& range, double opacity) {
  const FunctionChange change = change_of(colors, range, opacity);
  Look look = with_data(data, [&](const auto& of) {
    const ReleasedLock released;
    return choose_look(of, name, change);
  });
  py::dict result;
  const py::module_ scene = py::module_::import("pellucid.scene");
  result["name"] = look.name;
  result["reason"] = look.reason;
  result["as_labels"] = look.as_labels;
  result["transfer_function"] =
      std::make_shared<TransferFunction>(std::move(look.transfer_function));
  result["shading"] = py::none();
  if (look.shading) {
    const Shading& s = *look.shading;
    result["shading"] = scene.attr("Shading")(s.ambient, s.diffuse, s.specular, s.power);
  }
  py::list isosurfaces;
  for (const Isosurface& s : look.isosurfaces) {
    isosurfaces.append(scene.attr("Isosurface")(s.value, to_tuple(s.color), s.opacity));
  }
  result["isosurfaces"] = isosurfaces;
  return result;
}

py::list look_lights_of(const py::object& camera) {
  // The default camera looks from one side, whatever the data.
  std::array<Vec3<double>, 8> cube;
  for (unsigned n = 0; n < 8; ++n) cube[n] = {1.0 * (n & 1), 0.5 * (n & 2), 0.25 * (n & 4)};
  const Camera seen = camera.is_none() ? default_camera(cube, {1, 1}) : camera_of(camera);
  const py::module_ scene = py::module_::import("pellucid.scene");
  py::list lights;
  for (const Light& light : look_lights(seen)) {
    const auto* const directional = std::get_if<DirectionalLight>(&light.kind);
    lights.append(directional != nullptr
                      ? scene.attr("DirectionalLight")(to_tuple(directional->direction),
                                                       to_tuple(light.color))
                      : scene.attr("HeadLight")(to_tuple(light.color)));
  }
  return lights;
}

}  // namespace

void bind_looks(py::module_& module) {
  module.def("choose_look", &look_of, py::arg("data"), py::arg("name") = "",
             py::arg("colors") = py::none(), py::arg("range") = py::none(),
             py::arg("opacity") = 1.0, R"(
Returns what pellucid.look() makes a Layer of.)");
  module.def(
      "looks",
      [] {
        py::dict list;
        for (const LookName& look : looks()) {
          list[py::str(std::string(look.name))] = std::string(look.description);
        }
        return list;
      },
      R"(
Returns the looks by name, each with its description.)");
  module.def(
      "picture_advice",
      [](const py::object& scene, const ImageHandle& image) {
        const PythonScene read = read_scene(scene);
        const ReleasedLock released;
        return picture_advice(read.scene, *image.image);
      },
      py::arg("scene"), py::arg("image"), R"(
Returns why a picture shows next to nothing, or is burnt, and what to do; None: it is neither.)");
  module.def(
      "surface_advice",
      [](const py::object& scene) {
        const PythonScene read = read_scene(scene);
        const ReleasedLock released;
        return surface_advice(read.scene);
      },
      py::arg("scene"), R"(
Returns a sentence for each layer whose isosurfaces are at values that its data do not have, or
whose slices miss its data.)");
  module.def("look_lights", &look_lights_of, py::arg("camera") = py::none(), R"(
Returns the lights of a look in light, for a Camera or the default one: one at the eye and one from
the upper left, fixed in the world.)");
}

}  // namespace pellucid::python
