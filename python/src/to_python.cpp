// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>

#include "fields.h"
#include "handles.h"
#include "images.h"
#include "scenes.h"

namespace pellucid::python {

namespace {

/// Makes Python's objects of the parts of a scene.
class Maker {
 public:
  /// Returns an object of the class with the fields of a part, beside `arguments`.
  template <class Part>
  py::object part(const char* name, const Part& part, py::dict arguments = {}) const {
    scene_fields::visit_fields(part, FieldWriter(arguments));
    return of(name)(**arguments);
  }

  py::object light(const Light& light) const {
    static constexpr const char* classes[] = {"HeadLight", "DirectionalLight", "PointLight"};
    py::dict arguments;
    scene_fields::visit_fields(light, FieldWriter(arguments));
    const char* const name = classes[light.kind.index()];
    return std::visit([&](const auto& kind) { return part(name, kind, arguments); }, light.kind);
  }

  py::object clip(const Clip& clip) const {
    static constexpr const char* classes[] = {"ClipPlane", "ClipBox", "ClipSphere", "ClipCylinder"};
    py::dict arguments;
    arguments["keep"] = scene_fields::clip_sides[clip.keep_inside ? 0 : 1];
    const char* const name = classes[clip.shape.index()];
    return std::visit([&](const auto& shape) { return part(name, shape, arguments); }, clip.shape);
  }

  py::object layer(const Layer& layer, const LayerDescription& description) const {
    py::dict parts;
    parts["data"] = data(layer, description);
    const py::object function = this->function(layer, description);
    if (!function.is_none()) parts["transfer_function"] = function;
    parts["name"] = layer.name;
    parts["visible"] = layer.visible;
    const auto& map = layer.transform;
    const auto row = [&](int r) {
      return py::make_tuple(map.matrix.column[0][r], map.matrix.column[1][r],
                            map.matrix.column[2][r], map.translation[r]);
    };
    parts["transform"] = py::make_tuple(row(0), row(1), row(2));
    py::list clips, isosurfaces, slices;
    for (const Clip& each : layer.clips) clips.append(clip(each));
    for (const Isosurface& each : layer.isosurfaces) isosurfaces.append(part("Isosurface", each));
    for (const Slice& each : layer.slices) slices.append(part("Slice", each));
    parts["clips"] = clips;
    parts["isosurfaces"] = isosurfaces;
    parts["slices"] = slices;
    if (layer.projection) parts["projection"] = std::string(projection_name(*layer.projection));
    if (layer.shading) parts["shading"] = part("Shading", *layer.shading);
    if (layer.gradient_opacity) {
      parts["gradient_opacity"] = std::const_pointer_cast<GradientOpacity>(layer.gradient_opacity);
    }
    if (const auto* const labels = std::get_if<LabelContent>(&layer.content)) {
      parts["labels"] = held(labels->table);
    }
    const auto* const volume = std::get_if<VolumeContent>(&layer.content);
    if (volume != nullptr && volume->mask) {
      parts["mask"] = MaskHandle{volume->mask, {2, 1, 0}, description.mask->field};
    }
    return of("Layer")(**parts);
  }

  py::object of(const char* name) const { return scene_.attr(name); }

 private:
  static py::object data(const Layer& layer, const LayerDescription& description) {
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

  static py::object function(const Layer& layer, const LayerDescription& description) {
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

  py::module_ scene_ = py::module_::import("pellucid.scene");
};

}  // namespace

py::object to_python(const Camera& camera) {
  return Maker().part("Camera", camera);
}

py::object to_python(const Scene& scene, const SceneDescription& description) {
  const Maker make;
  py::list layers, lights, clips;
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    layers.append(make.layer(scene.layers[i], description.layers[i]));
  }
  for (const Light& light : scene.lights) lights.append(make.light(light));
  for (const Clip& clip : scene.clips) clips.append(make.clip(clip));
  py::dict parts;
  parts["layers"] = layers;
  parts["lights"] = lights;
  parts["clips"] = clips;
  if (description.camera) parts["camera"] = to_python(*description.camera);
  parts["size"] = py::make_tuple(scene.size.width, scene.size.height);
  parts["samples"] = scene.samples;
  parts["integration"] = make.part("Integration", scene.integration);
  if (description.is_transparent) parts["background"] = "transparent";
  if (const auto& background = scene.background) {
    if (background->is_even()) {
      parts["background"] = to_tuple(background->top);
    } else {
      parts["background"] = py::make_tuple(to_tuple(background->top), to_tuple(background->bottom));
    }
  }
  if (scene.backdrop) parts["backdrop"] = ImageHandle{scene.backdrop};
  return make.of("Scene")(**parts);
}

}  // namespace pellucid::python
