// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "pellucid/scene/defaults.h"
#include "tests/packet/random_frames.h"
#include "tests/scenes/makers.h"
#include "tests/support/one_layer.h"

namespace pellucid {

using Field = std::function<double(double, double, double)>;
using Points = std::vector<TransferFunction::Point>;

inline std::shared_ptr<const Volume> make_volume(const std::array<int, 3>& values,
                                                 const Field& field,
                                                 Vec3<double> spacing = {1, 1, 1}) {
  return scenes::make_volume<float>(scenes::grid_description(values, {0, 0, 0}, spacing), field);
}

class SmoothFrames : public RandomFrames {
 protected:
  SmoothFrames() : RandomFrames(17) {}

  /// Waves of so many cells and more, between 0 and 1.
  Field waves(int count, double shortest) {
    struct Wave {
      Vec3<double> k;
      double phase;
    };
    std::vector<Wave> all;
    for (int n = 0; n < count; ++n) {
      Vec3<double> k{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
      k = k * (2 * std::numbers::pi / (shortest * uniform(1, 3) * length(k)));
      all.push_back({k, uniform(0, 6.3)});
    }
    return [all](double x, double y, double z) {
      double sum = 0;
      for (const Wave& w : all) sum += std::sin(dot(w.k, Vec3<double>{x, y, z}) + w.phase);
      return 0.5 + 0.5 * sum / static_cast<double>(all.size());
    };
  }

  /// A field with a plane of values that stand out and a little of what looks like noise.
  static double with_noise(const Field& field, double x, double y, double z, double noise,
                           double odd) {
    const double wild = std::sin(12.9898 * x + 78.233 * y + 37.719 * z) * 43758.5453;
    return field(x, y, z) + noise * (2 * (wild - std::floor(wild)) - 1) + (x == odd ? noise : 0);
  }

  /// Extinction and colors linear over the data.
  static Points line(double depth, double size) {
    const double e = depth / size;
    return {{-0.1, 0.4 * e, {1, 0.2, 0.1}}, {1.1, 1.6 * e, {0.1, 0.7, 0.9}}};
  }
  /// A few points, with corners; some with a steep tooth where there are no data.
  Points corners(double depth, double size) {
    Points points;
    if (one_of(4)) {
      const double e = depth / size;
      points = {
          {-0.6, 0, {1, 1, 1}}, {-0.6 + power(1e-7, 1e-3), e, {1, 1, 1}}, {-0.5, e, {1, 1, 1}}};
    }
    double v = uniform(-0.3, 0.3);
    while (v < 1.1) {
      const double e = one_of(4) ? 0 : uniform(0, 2 * depth / size);
      points.push_back({v, e, {uniform(0, 1), uniform(0, 1), uniform(0, 1)}});
      v += one_of(3) ? uniform(0.02, 0.15) : uniform(0.1, 0.8);
    }
    points.push_back({1.2, uniform(0, 2 * depth / size), points.back().color});
    return points;
  }
  /// Smooth curves in a table.
  static Points table(double depth, double size) {
    Points points;
    for (int i = 0; i < 256; ++i) {
      const double v = i / 255.0;
      points.push_back({v, (0.5 + v) * depth / size, {v, 0.5 + 0.5 * std::cos(6 * v), 1 - v}});
    }
    return points;
  }

  static Scene make_scene(std::shared_ptr<const Volume> volume, Points points,
                          Vec3<double> direction, bool orthographic) {
    Scene scene;
    test::volume_of(scene).volume = std::move(volume);
    test::volume_of(scene).transfer_function =
        std::make_shared<TransferFunction>(std::move(points));
    scene.size = {20, 20};
    scene.camera = default_camera(*test::volume_of(scene).volume, scene.size);
    const double far = length(scene.camera.position - scene.camera.focal_point);
    scene.camera.position = scene.camera.focal_point + direction * (far / length(direction));
    scene.camera.up = std::fabs(direction.z) > 0.9 * length(direction) ? Vec3<double>{0, 1, 0}
                                                                       : Vec3<double>{0, 0, 1};
    if (orthographic) {
      scene.camera.projection = Projection::orthographic;
      scene.camera.parallel_scale = 0.3 * far;
    }
    return scene;
  }
};

inline const Vec3<double> directions[] = {{1, 0, 0}, {0, 1, 1},        {1, 1, 1},   {2, 1, 0},
                                          {3, 1, 2}, {0.3, -0.8, 0.5}, {1, 0.01, 0}};

}  // namespace pellucid
