// SPDX-License-Identifier: Apache-2.0
#include "tests/cuda/device_examples.h"

#include <memory>

#include "tests/scenes/gallery.h"
#include "tests/scenes/layer_makers.h"
#include "tests/scenes/meshes.h"

namespace pellucid::scenes {
namespace {

Layer in_light(Layer layer, GradientKind gradient) {
  layer.shading = Shading{};
  layer.shading->gradient = gradient;
  return layer;
}

Layer with_gradient_opacity(Layer layer) {
  layer.gradient_opacity = std::make_shared<const GradientOpacity>(
      std::vector<GradientOpacity::Point>{{0, 0.2}, {0.5, 1}, {2, 1.5}});
  return layer;
}

Layer gaussians_on_a_mesh() {
  const MeshPointer cubes = make_mesh(box_of_cubes(3));
  const MeshChannelsPointer channels =
      on_mesh(cubes, {at_points(*cubes, "a", [](const Vec3<double>& p) { return p.x * p.y; }),
                      at_cells(*cubes, "b", [](const Vec3<double>& p) { return p.z; })});
  const GaussianPrimitive first{{0, 1}, {0.2, 0.1}, matrix_from_widths({0.3, 0.5}), 2, {1, 0.5, 0}};
  return {MeshContent{channels, std::make_shared<const MultivariateTransferFunction>(
                                    2, std::vector<GaussianPrimitive>{first})}};
}

}  // namespace

std::vector<DeviceExample> device_examples(int size) {
  std::vector<DeviceExample> result;
  const auto add = [&](const char* name, Layer layer, bool backdrop = false) {
    Exhibit all = exhibit({std::move(layer)});
    all.backdrop = backdrop;
    all.lights = {Light{}, Light{DirectionalLight{{1, -1, -0.5}}, {0.5, 0.4, 0.3}},
                  Light{PointLight{{0.1, 0.2, 0.3}}, {0.2, 0.3, 0.6}}};
    result.push_back({name, scene_of(all, 1, size)});
  };
  add("grid", grid({9, 8, 7}, jumps(3)));
  add("vacuum", with_vacuum(ramp(2, {1, 0, 0}, {0, 0.5, 1})));
  add("oblique cells before a backdrop", oblique_cells(jumps(3)), true);
  add("lit grid", in_light(grid({9, 8, 7}, jumps(3)), GradientKind::smooth));
  add("lit cells by the field's gradient",
      in_light(oblique_cells(ramp(2, {1, 0, 0}, {0, 0.5, 1})), GradientKind::field));
  add("gradient opacity", with_gradient_opacity(with_vacuum(ramp(2, {1, 0, 0}, {0, 0.5, 1}))));
  add("gaussians", gaussians());
  add("mesh", mesh(3, jumps(3)));
  add("gaussians on a mesh", gaussians_on_a_mesh());
  return result;
}

}  // namespace pellucid::scenes
