// SPDX-License-Identifier: Apache-2.0
#include "scenes.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "fields.h"
#include "handles.h"
#include "images.h"
#include "pellucid/cpu/framed_camera.h"
#include "pellucid/scene/defaults.h"
#include "pellucid/scene/view_camera.h"

namespace pellucid::python {

namespace {

/// Throws Error unless the object has what only objects of this class have.
void check_kind(const py::handle& object, const char* attribute, const std::string& what,
                const char* expected) {
  if (py::hasattr(object, attribute)) return;
  throw Error(what + ": expected a " + expected + ", got " + short_repr(object));
}

/// Returns the kind of a light or a clip. Throws Error for other objects.
std::string kind_of(const py::handle& object, const std::string& what, const char* expected) {
  if (!py::hasattr(object, "_kind")) {
    throw Error(what + ": expected " + expected + ", got " + short_repr(object));
  }
  return py::cast<std::string>(object.attr("_kind"));
}

/// Reads one of several kinds of parts.
template <class Variant>
Variant kind_from(const py::handle& object, const std::string& what,
                  std::span<const char* const> kinds, const char* expected) {
  const auto found = std::ranges::find(kinds, kind_of(object, what, expected));
  Variant made =
      scene_fields::alternative<Variant>(static_cast<std::size_t>(found - kinds.begin()));
  std::visit([&](auto& part) { scene_fields::visit_fields(part, FieldReader(object, what)); },
             made);
  return made;
}

Light light_of(const py::handle& object, const std::string& what) {
  Light light{kind_from<decltype(Light::kind)>(object, what, scene_fields::light_kinds,
                                               "HeadLight, DirectionalLight or PointLight")};
  scene_fields::visit_fields(light, FieldReader(object, what));
  return light;
}

Clip clip_of(const py::handle& object, const std::string& what) {
  Clip clip{kind_from<decltype(Clip::shape)>(object, what, scene_fields::clip_shapes,
                                             "ClipPlane, ClipBox, ClipSphere or ClipCylinder")};
  clip.keep_inside = choice(object.attr("keep"), what + ".keep", scene_fields::clip_sides) == 0;
  return clip;
}

template <class Read>
auto list_of(const py::object& list, const std::string& what, Read&& read) {
  std::vector<decltype(read(list, what))> result;
  if (!py::isinstance<py::iterable>(list)) {
    throw Error(what + ": expected a list, got " + short_repr(list));
  }
  for (const py::handle entry : list) {
    result.push_back(read(entry, what + " " + std::to_string(result.size() + 1)));
  }
  return result;
}

Shading shading_of(const py::object& object, const std::string& what) {
  check_kind(object, "flatness", what, "pellucid.Shading");
  return part_of<Shading>(object, what);
}

Isosurface isosurface_of(const py::handle& object, const std::string& what) {
  check_kind(object, "color_channel", what, "pellucid.Isosurface");
  return part_of<Isosurface>(object, what);
}

Slice slice_of(const py::handle& object, const std::string& what) {
  check_kind(object, "normal", what, "pellucid.Slice");
  return part_of<Slice>(object, what);
}

/// Reads three rows of four numbers, or four as of a 4 x 4 matrix.
Affine<double> transform_of(const py::object& object, const std::string& what) {
  const auto rows = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(object);
  if (!rows) PyErr_Clear();
  if (!rows || rows.ndim() != 2 || rows.shape(1) != 4 || rows.shape(0) < 3 || rows.shape(0) > 4) {
    throw Error(what + ": expected three rows of four numbers, got " + short_repr(object));
  }
  const bool is_affine = rows.shape(0) == 3 || (rows.at(3, 0) == 0 && rows.at(3, 1) == 0 &&
                                                rows.at(3, 2) == 0 && rows.at(3, 3) == 1);
  if (!is_affine) throw Error(what + ": the last row of an affine map is 0, 0, 0, 1");
  Affine<double> map;
  for (py::ssize_t c = 0; c < 3; ++c) {
    map.matrix.column[c] = {rows.at(0, c), rows.at(1, c), rows.at(2, c)};
  }
  map.translation = {rows.at(0, 3), rows.at(1, 3), rows.at(2, 3)};
  return map;
}

/// Puts a layer's function into its content and its description. Opacity tables get points for the
/// default tolerance; complete_scene() makes them again.
class FunctionReader {
 public:
  FunctionReader(const py::object& function, const std::string& what)
      : object_(function), what_(what) {}

  std::shared_ptr<const TransferFunction> univariate(LayerDescription& description) const {
    if (py::isinstance<TransferFunction>(object_)) {
      auto function = py::cast<std::shared_ptr<TransferFunction>>(object_);
      description.transfer_function = function->points();
      return function;
    }
    if (py::isinstance<OpacityTableHandle>(object_)) {
      const auto& handle = py::cast<const OpacityTableHandle&>(object_);
      description.transfer_function = handle.table;
      if (!handle.fitted) {
        handle.fitted = std::make_shared<const TransferFunction>(
            make_transfer_function(handle.table, default_tolerance));
      }
      return handle.fitted;
    }
    throw Error(what_ + ": expected a TransferFunction or an OpacityTable, got " +
                short_repr(object_));
  }

  /// Returns the function of several variables. `channels`: those of the data.
  template <class Data>
  std::shared_ptr<const MultivariateTransferFunction> multivariate(
      const Data& channels, LayerDescription& description) const {
    if (!is_multivariate()) {
      throw Error(what_ + ": several variables need Gaussians, got " + short_repr(object_));
    }
    const auto& handle = py::cast<const GaussiansHandle&>(object_);
    std::vector<std::string> names;
    for (int i = 0; i < channels.count(); ++i) names.push_back(channels[i].name);
    if (handle.channels != names) {
      const auto list = [](const std::vector<std::string>& of) {
        std::string text;
        for (const std::string& name : of) text += (text.empty() ? "" : ", ") + name;
        return text;
      };
      throw Error(what_ + ": the Gaussians are of the channels " + list(handle.channels) +
                  ", but the data have " + list(names) + "; make them for these, in this order");
    }
    description.transfer_function = handle.description;
    return handle.function;
  }

  bool is_multivariate() const { return py::isinstance<GaussiansHandle>(object_); }

 private:
  const py::object& object_;
  const std::string& what_;
};

FieldSource in_memory() {
  FieldSource source;
  source.file = array_in_memory;
  return source;
}

/// Returns the mask with the memory order of a volume (in_order_of()).
std::shared_ptr<const LabelMask> in_order_of(const VolumeHandle& like, const MaskHandle& masking) {
  if (masking.axes == like.axes) return masking.mask;
  if (!masking.reordered || masking.reordered_axes != like.axes) {
    const VolumeHandle labels =
        in_order_of(like, VolumeHandle{masking.mask->labels().shared_volume(), masking.axes});
    const ReleasedLock released;
    masking.reordered = std::make_shared<const LabelMask>(
        std::make_shared<const LabelVolume>(labels.volume), masking.mask->choices());
    masking.reordered_axes = like.axes;
  }
  return masking.reordered;
}

LayerContent content_of(const py::object& layer, const std::string& what,
                        LayerDescription& description) {
  const py::object data = layer.attr("data");
  const std::string function_name = what + ": transfer_function";
  const py::object function_object = layer.attr("transfer_function");
  const FunctionReader function(function_object, function_name);
  const py::object mask = layer.attr("mask");
  if (py::isinstance<VolumeHandle>(data)) {
    const auto& handle = py::cast<const VolumeHandle&>(data);
    description.field = handle.source.value_or(in_memory());
    VolumeContent content{handle.volume, function.univariate(description)};
    if (!mask.is_none()) {
      const auto& masking = py::cast<const MaskHandle&>(mask);
      content.mask = in_order_of(handle, masking);
      description.mask.emplace();
      description.mask->field = masking.source.value_or(in_memory());
      for (const LabelMask::Choice& c : masking.mask->choices()) {
        description.mask->choices.push_back({c.label, c.transfer_function->points()});
      }
    }
    return content;
  }
  if (py::isinstance<ChannelsHandle>(data)) {
    const auto& handle = py::cast<const ChannelsHandle&>(data);
    description.channels = handle.sources;
    for (int i = 0; handle.sources.empty() && i < handle.channels->count(); ++i) {
      const Channel& channel = (*handle.channels)[i];
      description.channels.push_back({channel.name, channel.unit, in_memory()});
    }
    return ChannelsContent{handle.channels, function.multivariate(*handle.channels, description)};
  }
  if (py::isinstance<MeshHandle>(data)) {
    const auto& handle = py::cast<const MeshHandle&>(data);
    description.mesh = handle.source.value_or(MeshSource{array_in_memory, {}, {}});
    for (int i = 0; !handle.source && i < handle.mesh->count(); ++i) {
      const std::string& name = (*handle.mesh)[i].name;
      description.mesh->channels.push_back({name, {}, name});
    }
    MeshContent content{handle.mesh, {}};
    if (function.is_multivariate()) {
      content.transfer_function = function.multivariate(*handle.mesh, description);
    } else {
      content.transfer_function = function.univariate(description);
    }
    return content;
  }
  if (py::isinstance<LabelHandle>(data)) {
    const auto& handle = py::cast<const LabelHandle&>(data);
    const py::object table = layer.attr("labels");
    if (!py::isinstance<LabelTable>(table)) {
      throw Error(what + ": labels: expected a LabelTable, got " + short_repr(table));
    }
    LabelContent content{handle.labels, py::cast<std::shared_ptr<LabelTable>>(table)};
    description.labels =
        LabelSource{handle.source.value_or(in_memory()), content.table->styles(), {}, {}};
    return content;
  }
  throw Error(what + ": data: expected a Volume, Channels, a Mesh or a LabelVolume, got " +
              short_repr(data));
}

Layer layer_of(const py::object& object, const std::string& what, LayerDescription& description) {
  Layer layer;
  layer.content = content_of(object, what, description);
  layer.name = text_of(object.attr("name"), what + ": name");
  layer.visible = py::cast<bool>(py::bool_(object.attr("visible")));
  layer.transform = transform_of(object.attr("transform"), what + ": transform");
  layer.clips = list_of(object.attr("clips"), what + ": clip", clip_of);
  if (const py::object projection = object.attr("projection"); !projection.is_none()) {
    layer.projection =
        static_cast<LayerProjection>(choice(projection, what + ": projection", projection_names,
                                            "\"maximum\", \"minimum\", \"mean\" or \"sum\""));
  }
  if (const py::object shading = object.attr("shading"); !shading.is_none()) {
    layer.shading = shading_of(shading, what + ": shading");
  }
  if (const py::object opacity = object.attr("gradient_opacity"); !opacity.is_none()) {
    if (!py::isinstance<GradientOpacity>(opacity)) {
      throw Error(what + ": gradient_opacity: expected a GradientOpacity, got " +
                  short_repr(opacity));
    }
    layer.gradient_opacity = py::cast<std::shared_ptr<GradientOpacity>>(opacity);
  }
  layer.isosurfaces = list_of(object.attr("isosurfaces"), what + ": isosurface", isosurface_of);
  layer.slices = list_of(object.attr("slices"), what + ": slice", slice_of);
  return layer;
}

Integration integration_of(const py::object& object) {
  check_kind(object, "grade", "integration", "pellucid.Integration");
  return part_of<Integration>(object, "");
}

/// Gives each opacity table the points that the scene's tolerance wants, or the last ones if they
/// are the same.
void fit_tables(PythonScene& made, const py::object& layers) {
  fit_opacity_tables(made.description, made.scene);
  std::size_t i = 0;
  for (const py::handle object : layers) {
    if (i == made.scene.layers.size()) break;  // another thread added one
    Layer& layer = made.scene.layers[i++];
    const py::object function = object.attr("transfer_function");
    if (!py::isinstance<OpacityTableHandle>(function)) continue;
    const auto& handle = py::cast<const OpacityTableHandle&>(function);
    const auto share = [&](std::shared_ptr<const TransferFunction>& fitted) {
      if (handle.fitted && handle.fitted->relative_error() == fitted->relative_error() &&
          handle.fitted->points() == fitted->points()) {
        fitted = handle.fitted;
      } else {
        handle.fitted = fitted;
      }
    };
    if (auto* volume = std::get_if<VolumeContent>(&layer.content)) share(volume->transfer_function);
    if (auto* mesh = std::get_if<MeshContent>(&layer.content)) {
      share(std::get<std::shared_ptr<const TransferFunction>>(mesh->transfer_function));
    }
  }
}

}  // namespace

std::string text_of(const py::object& object, const std::string& what) {
  if (!py::isinstance<py::str>(object)) {
    throw Error(what + ": expected a text, got " + short_repr(object));
  }
  return py::cast<std::string>(object);
}

std::size_t choice(const py::object& object, const std::string& what,
                   std::span<const char* const> names, const char* expected) {
  const auto found = std::ranges::find(names, text_of(object, what));
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  std::string list;
  for (const char* const name : names)
    list += (list.empty() ? "\"" : ", \"") + std::string(name) + "\"";
  throw Error(what + ": expected " + (expected != nullptr ? expected : "one of " + list) +
              ", got " + short_repr(object));
}

int integer_of(const py::object& object, const std::string& what) {
  const Py_ssize_t number = py::isinstance<py::bool_>(object) ? -1
                            : PyLong_Check(object.ptr()) != 0 || PyIndex_Check(object.ptr()) != 0
                                ? PyNumber_AsSsize_t(object.ptr(), nullptr)
                                : -1;
  if (PyErr_Occurred() != nullptr || number < 0 || number > std::numeric_limits<int>::max()) {
    PyErr_Clear();
    throw Error(what + ": expected a whole number from 0, got " + short_repr(object));
  }
  return static_cast<int>(number);
}

std::shared_ptr<const TransferFunction> colors_of(const py::object& object,
                                                  const std::string& what) {
  if (object.is_none()) return nullptr;
  if (!py::isinstance<TransferFunction>(object)) {
    throw Error(what + ": expected a TransferFunction or None, got " + short_repr(object));
  }
  return py::cast<std::shared_ptr<TransferFunction>>(object);
}

Camera camera_of(const py::object& object) {
  check_kind(object, "focal_point", "camera", "pellucid.Camera");
  return part_of<Camera>(object, "camera");
}

SceneDescription described(const PythonScene& made) {
  const Scene& scene = made.scene;
  SceneDescription description = made.description;
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    LayerDescription& layer = description.layers[i];
    static_cast<Layer&>(layer) = scene.layers[i];
    layer.content = {};
    name_channels(layer);
  }
  static_cast<SceneSettings&>(description) = scene;
  if (made.has_camera) description.camera = scene.camera;
  description.is_transparent = made.is_transparent;
  return description;
}

PythonScene read_scene(const py::object& object) {
  PythonScene made;
  Scene& scene = made.scene;
  made.description.layers.clear();
  if (!py::hasattr(object, "layers") || !py::hasattr(object, "integration")) {
    throw Error("scene: expected a pellucid.Scene, got " + short_repr(object) +
                "; pellucid.scene_of() makes one of data");
  }
  for (const py::handle layer : object.attr("layers")) {
    const std::string what = "layer " + std::to_string(scene.layers.size() + 1);
    if (!py::hasattr(layer, "transfer_function")) {
      throw Error(what + ": expected a pellucid.Layer, got " + short_repr(layer));
    }
    LayerDescription& description = made.description.layers.emplace_back();
    scene.layers.push_back(layer_of(py::reinterpret_borrow<py::object>(layer), what, description));
  }
  const py::object size = object.attr("size");
  if (!py::isinstance<py::sequence>(size) || py::len(size) != 2) {
    throw Error("size: expected (width, height) in pixels, got " + short_repr(size));
  }
  scene.size = {integer_of(size[py::int_(0)], "size: width"),
                integer_of(size[py::int_(1)], "size: height")};
  scene.lights = list_of(object.attr("lights"), "light", light_of);
  scene.clips = list_of(object.attr("clips"), "clip", clip_of);
  if (const py::object background = object.attr("background"); !background.is_none()) {
    scene.background = background_from(background);
  }
  made.is_transparent = !shown_background(object);
  scene.samples = integer_of(object.attr("samples"), "samples");
  scene.integration = integration_of(object.attr("integration"));
  if (const py::object animation = object.attr("animation"); !animation.is_none()) {
    const py::object text = py::module_::import("json").attr("dumps")(animation);
    made.description.animation = parse_animation(py::cast<std::string>(text), "animation");
  }
  if (const py::object backdrop = object.attr("backdrop"); !backdrop.is_none()) {
    if (!py::isinstance<ImageHandle>(backdrop)) {
      throw Error("backdrop: expected an Image with depth, got " + short_repr(backdrop));
    }
    scene.backdrop = py::cast<const ImageHandle&>(backdrop).image;
  }
  if (const py::object camera = object.attr("camera"); !camera.is_none()) {
    scene.camera = camera_of(camera);
    made.has_camera = true;
  }
  check_data(scene);
  return made;
}

PythonScene complete_python_scene(const py::object& object) {
  PythonScene made = read_scene(object);
  check_integration(made.scene);
  fit_tables(made, object.attr("layers"));
  if (!made.has_camera) {
    make_camera_frame({}, made.scene.size);  // throws where the size is out of range
    const ReleasedLock released;
    made.scene.camera = framed_camera(
        made.scene, default_camera(visible_corners(made.scene, all_cores()), made.scene.size));
  }
  return made;
}

Scene complete_scene(const py::object& object) {
  return std::move(complete_python_scene(object).scene);
}

void bind_scenes(py::module_& module) {
  module.def(
      "default_camera",
      [](const py::object& object) { return to_python(complete_scene(object).camera); },
      py::arg("scene"), R"(
Returns the scene's camera; if it has none, the one that shows all that is visible.)");
  module.def(
      "view_camera",
      [](const py::object& object, const std::string& view) {
        const auto& names = view_names();
        if (std::ranges::find(names, view) == names.end()) {
          throw Error(
              "view: expected front, back, left, right, top, bottom or oblique, "
              "got \"" +
              view + "\"");
        }
        const Scene scene = complete_scene(object);
        const ReleasedLock released;
        const Camera camera = framed_camera(
            scene, view_camera(visible_corners(scene, all_cores()), view, scene.size));
        const py::gil_scoped_acquire acquired;
        return to_python(camera);
      },
      py::arg("scene"), py::arg("view"), R"(
Returns a camera that looks at the scene from a side: "front", "back", "left", "right", "top",
"bottom" of a patient in an LPS world, or "oblique".)");
}

}  // namespace pellucid::python
