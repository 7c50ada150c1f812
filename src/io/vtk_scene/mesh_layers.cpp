// SPDX-License-Identifier: Apache-2.0
#include "mesh_layers.h"

#include <algorithm>
#include <string>

#include "cropping.h"
#include "pellucid/scene/error.h"
#include "placement.h"

namespace pellucid::vtk_scene {
namespace {

double size_of(const MeshChannels& mesh) {
  const Vec3<double> size = mesh.mesh().bounds().upper - mesh.mesh().bounds().lower;
  return std::max({size.x, size.y, size.z});
}

}  // namespace

void check_mesh_array(int components, const std::string& class_name) {
  if (components < 1) {
    throw Error(class_name +
                ": has no values to show; give it scalars, or select one of its arrays");
  }
  if (components > 1) {
    throw Error("the array has " + std::to_string(components) +
                " components; one is shown, extract it");
  }
}

Layer layer_of(const MeshVolume& volume, double tolerance, KeptMeshLooks& kept, Notes& notes) {
  Layer layer;
  layer.transform = affine_of(volume.matrix, "volume");
  layer.clips = clips_of(volume.mapper.clipping, notes);
  if (volume.mapper.blend == Blend::maximum) layer.projection = LayerProjection::maximum;
  const auto meaning = layer.projection ? OpacityMeaning::projected : OpacityMeaning::extinction;
  FunctionReader reader(tolerance, kept.curves, notes);
  const ComponentSettings& look = volume.property.components.at(0);
  const LookRecipe recipe =
      look_recipe(look, meaning, tolerance, size_of(*volume.mesh), {}, reader, notes);
  layer.content = MeshContent{volume.mesh, kept.functions.find(recipe, function_of)};
  if (look.reflection) notes.add("volumes of unstructured grids have no light");
  return layer;
}

}  // namespace pellucid::vtk_scene
