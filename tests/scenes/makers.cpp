// SPDX-License-Identifier: Apache-2.0
#include "tests/scenes/makers.h"

#include <algorithm>
#include <cmath>

#include "pellucid/scene/builtin_fields.h"
#include "tests/support/one_layer.h"

namespace pellucid::scenes {

Volume::Description grid_description(std::array<int, 3> dimensions, Vec3<double> origin,
                                     Vec3<double> spacing) {
  Volume::Description d;
  d.dimensions = dimensions;
  d.placement.origin = origin;
  d.placement.spacing = spacing;
  d.name = "grid";
  return d;
}

VolumePointer sampled(std::array<int, 3> dimensions, const FieldFunction& f, const char* name,
                      Centering centering) {
  Volume::Description d;
  d.dimensions = dimensions;
  d.centering = centering;
  d.name = name;
  for (int a = 0; a < 3; ++a) {
    const int n = dimensions[static_cast<std::size_t>(a)];
    const bool cell = centering == Centering::cell;
    d.placement.spacing[a] = cell ? 2.0 / n : 2.0 / (n - 1);
    d.placement.origin[a] = cell ? -1 + 1.0 / n : -1;
  }
  const GridPlacement placement = d.placement;
  const auto at = [&](int a, int i) { return placement.origin[a] + i * placement.spacing[a]; };
  return make_volume<float>(std::move(d),
                            [&](int i, int j, int k) { return f(at(0, i), at(1, j), at(2, k)); });
}

VolumePointer builtin(const char* name, int points) {
  return std::make_shared<const Volume>(make_builtin_field(name, points));
}

TransferPointer transfer(Points points) {
  return std::make_shared<const TransferFunction>(std::move(points));
}

Rgb<double> tabulated_color(double value) {
  const auto entry = [](double i) {
    const double x = i / 255;
    return Rgb<double>{x, 0.5 + 0.5 * std::cos(7 * x), 1 - x};
  };
  const double position = std::clamp(value, 0.0, 1.0) * 255;
  const double i = std::min(std::floor(position), 254.0);
  return entry(i) * (i + 1 - position) + entry(i + 1) * (position - i);
}

TransferPointer with_tabulated_color(const std::function<double(double)>& extinction,
                                     const std::vector<double>& corners) {
  std::vector<double> values = corners;
  for (int i = 0; i < 256; ++i) values.push_back(i / 255.0);
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  Points points;
  for (const double v : values) points.push_back({v, extinction(v), tabulated_color(v)});
  return transfer(std::move(points));
}

Scene make_scene(VolumePointer volume, TransferPointer transfer_function, const Camera& camera,
                 ImageSize size) {
  Scene scene;
  test::volume_of(scene).volume = std::move(volume);
  test::volume_of(scene).transfer_function = std::move(transfer_function);
  scene.camera = camera;
  scene.size = size;
  return scene;
}

}  // namespace pellucid::scenes
