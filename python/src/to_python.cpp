// SPDX-License-Identifier: Apache-2.0
#include <span>
#include <string>
#include <utility>

#include "fields.h"
#include "handles.h"
#include "images.h"
#include "scenes.h"

namespace pellucid::python {

namespace {

/// Returns an object of a light or a clip: of the class of its kind, with that kind's fields.
template <class Kind>
py::object object_of_kind(std::span<const char* const> classes, const Kind& kind,
                          const py::dict& arguments) {
  const char* const name = classes[kind.index()];
  return std::visit([&](const auto& part) { return object_of(name, part, arguments); }, kind);
}

py::object data_of(const Layer& layer, const LayerDescription& description) {
  if (const auto* const volume = std::get_if<VolumeContent>(&layer.content)) {
    return py::cast(VolumeHandle{volume->volume, {2, 1, 0}, description.field});
  }
  if (const auto* const channels = std::get_if<ChannelsContent>(&layer.content)) {
    return py::cast(
        ChannelsHandle{channels->channels,
                       std::vector<std::array<std::size_t, 3>>(
                           static_cast<std::size_t>(channels->channels->count()), {2, 1, 0}),
                       layer_channels(description)});
  }
  if (const auto* const mesh = std::get_if<MeshContent>(&layer.content)) {
    return py::cast(MeshHandle{mesh->mesh, description.mesh});
  }
  return py::cast(LabelHandle{
      std::get<LabelContent>(layer.content).labels, {2, 1, 0}, description.labels->field});
}

py::object function_of(const Layer& layer, const LayerDescription& description) {
  const auto& described = description.transfer_function;
  if (described) {
    if (const auto* const table = std::get_if<OpacityTable>(&*described)) {
      return py::cast(OpacityTableHandle{*table});
    }
  }
  const auto gaussians = [&](const std::shared_ptr<const MultivariateTransferFunction>& made) {
    GaussiansHandle handle{made, {}, function_channels(description)};
    if (described) {
      handle.description = std::get<MultivariateDescription>(*described);
    } else {
      handle.description.tables.push_back(
          {handle.channels.front(), made->tables().front().function});
    }
    return py::cast(std::move(handle));
  };
  if (const auto* const volume = std::get_if<VolumeContent>(&layer.content)) {
    return py::cast(held(volume->transfer_function));
  }
  if (const auto* const channels = std::get_if<ChannelsContent>(&layer.content)) {
    return gaussians(channels->transfer_function);
  }
  const auto* const mesh = std::get_if<MeshContent>(&layer.content);
  if (mesh == nullptr) return py::none();
  const auto* const one =
      std::get_if<std::shared_ptr<const TransferFunction>>(&mesh->transfer_function);
  if (one != nullptr) return py::cast(held(*one));
  return gaussians(
      std::get<std::shared_ptr<const MultivariateTransferFunction>>(mesh->transfer_function));
}

py::object layer_object(const Layer& layer, const LayerDescription& description) {
  py::dict parts = look_arguments(layer);
  parts["data"] = data_of(layer, description);
  const py::object function = function_of(layer, description);
  if (!function.is_none()) parts["transfer_function"] = function;
  if (const auto* const labels = std::get_if<LabelContent>(&layer.content)) {
    parts["labels"] = held(labels->table);
  }
  const auto* const volume = std::get_if<VolumeContent>(&layer.content);
  if (volume != nullptr && volume->mask) {
    parts["mask"] = MaskHandle{volume->mask, {2, 1, 0}, description.mask->field};
  }
  return scene_class("Layer")(**parts);
}

}  // namespace

py::object scene_class(const char* name) {
  return py::module_::import("pellucid.scene").attr(name);
}

py::object to_python(const Camera& camera) {
  return object_of("Camera", camera);
}

py::object to_python(const Light& light) {
  static constexpr const char* classes[] = {"HeadLight", "DirectionalLight", "PointLight"};
  py::dict arguments;
  scene_fields::visit_fields(light, FieldWriter(arguments));
  return object_of_kind(classes, light.kind, arguments);
}

py::object to_python(const Clip& clip) {
  static constexpr const char* classes[] = {"ClipPlane", "ClipBox", "ClipSphere", "ClipCylinder"};
  py::dict arguments;
  arguments["keep"] = scene_fields::clip_sides[clip.keep_inside ? 0 : 1];
  return object_of_kind(classes, clip.shape, arguments);
}

py::dict look_arguments(const Layer& layer) {
  py::dict parts;
  parts["name"] = layer.name;
  parts["visible"] = layer.visible;
  const auto& map = layer.transform;
  const auto row = [&](int r) {
    return py::make_tuple(map.matrix.column[0][r], map.matrix.column[1][r], map.matrix.column[2][r],
                          map.translation[r]);
  };
  parts["transform"] = py::make_tuple(row(0), row(1), row(2));
  py::list clips, isosurfaces, slices;
  for (const Clip& each : layer.clips) clips.append(to_python(each));
  for (const Isosurface& each : layer.isosurfaces)
    isosurfaces.append(object_of("Isosurface", each));
  for (const Slice& each : layer.slices) slices.append(object_of("Slice", each));
  parts["clips"] = clips;
  parts["isosurfaces"] = isosurfaces;
  parts["slices"] = slices;
  if (layer.projection) parts["projection"] = std::string(projection_name(*layer.projection));
  if (layer.shading) parts["shading"] = object_of("Shading", *layer.shading);
  if (layer.gradient_opacity) {
    parts["gradient_opacity"] = held(layer.gradient_opacity);
  }
  return parts;
}

py::object to_python(const Scene& scene, const SceneDescription& description) {
  py::list layers, lights, clips;
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    layers.append(layer_object(scene.layers[i], description.layers[i]));
  }
  for (const Light& light : scene.lights) lights.append(to_python(light));
  for (const Clip& clip : scene.clips) clips.append(to_python(clip));
  py::dict parts;
  parts["layers"] = layers;
  parts["lights"] = lights;
  parts["clips"] = clips;
  if (description.camera) parts["camera"] = to_python(*description.camera);
  parts["size"] = py::make_tuple(scene.size.width, scene.size.height);
  parts["samples"] = scene.samples;
  parts["integration"] = object_of("Integration", scene.integration);
  if (description.is_transparent) parts["background"] = "transparent";
  if (const auto& background = scene.background) {
    if (background->is_even()) {
      parts["background"] = to_tuple(background->top);
    } else {
      parts["background"] = py::make_tuple(to_tuple(background->top), to_tuple(background->bottom));
    }
  }
  if (description.animation) {
    parts["animation"] =
        py::module_::import("json").attr("loads")(animation_to_json(*description.animation));
  }
  if (scene.backdrop) parts["backdrop"] = ImageHandle{scene.backdrop};
  return scene_class("Scene")(**parts);
}

}  // namespace pellucid::python
