// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <numbers>
#include <random>
#include <utility>
#include <variant>
#include <vector>

#include "tests/scenes/makers.h"

namespace pellucid {

/// Random scenes whose data repeat along one axis of their grid, and others that do not, in light.
/// Cells that are alike have errors that are alike: those of a ray do not cancel.
class RepeatingScenes {
 public:
  explicit RepeatingScenes(unsigned seed) : random_(seed) {}

  /// Returns a volume in light. Its cells repeat along its longest axis, in most scenes; the view
  /// is along that axis, across it or from anywhere.
  Scene lit() {
    const double kind = uniform(0, 1);
    const int length = one_of({9, 17, 17, 33, 65, 129, 241});
    std::array<int, 3> values{length, whole(3, 5), whole(3, 5)};
    Scene scene = kind < 0.3   ? of_type<std::uint8_t>(values, 200)
                  : kind < 0.4 ? of_type<std::int16_t>(values, 3000)
                               : of_type<float>(values, one_of({1.0, 100.0}));
    Layer& layer = scene.layers[0];
    layer.shading = Shading{one_of({0.0, 0.1, 0.3}),
                            one_of({0.0, 0.7, 1.0, 2.0}),
                            one_of({0.0, 0.3, 1.0, 2.0}),
                            one_of({1.0, 1.2, 1.5, 2.0, 2.2, 3.0, 5.0, 20.0, 100.0, 500.0}),
                            happens(0.5) ? GradientKind::smooth : GradientKind::field,
                            one_of({0.0, 0.0, 0.02, 0.1, 0.3})};
    const int lights = happens(0.7) ? 1 : whole(2, 3);
    for (int n = 0; n < lights; ++n) scene.lights.push_back({light(), random_color(2)});
    return scene;
  }

  /// Returns an unlit volume of smooth waves that repeat along one axis.
  Scene smooth() {
    const int length = one_of({65, 129, 241, 500});
    return of_type<float>({length, whole(20, 33), whole(20, 33)}, 1, true);
  }

 private:
  double uniform(double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random_);
  }
  double power(double a, double b) { return a * std::pow(b / a, uniform(0, 1)); }
  bool happens(double share) { return uniform(0, 1) < share; }
  int whole(int a, int b) { return std::uniform_int_distribution<int>(a, b)(random_); }
  template <class T>
  T one_of(std::initializer_list<T> values) {
    return values.begin()[whole(0, static_cast<int>(values.size()) - 1)];
  }
  Rgb<double> random_color(double most) {
    return {uniform(0, most), uniform(0, most), uniform(0, most)};
  }
  Vec3<double> direction() {
    for (;;) {
      const Vec3<double> d{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
      if (length(d) > 0.1) return normalized(d);
    }
  }
  std::variant<HeadLight, DirectionalLight, PointLight> light() {
    const double kind = uniform(0, 1);
    if (kind < 0.5) return HeadLight{};
    if (kind < 0.85) return DirectionalLight{direction()};
    return PointLight{power(1, 300) * direction()};
  }

  /// Returns values in [0, 1] that repeat along x every few planes. Over y and z the pattern stays,
  /// shifts or is another one; its size may change slowly along x, and noise may lie over it.
  std::function<double(int, int, int)> pattern() {
    const int period = happens(0.15) ? 1000 : happens(0.5) ? 2 : whole(2, 9);
    struct Numbers {
      int period, shift_y, shift_z;
      double noise, fade;
      std::vector<double> value;
    };
    Numbers n{period,
              whole(0, 1) * whole(0, 2),
              whole(0, 1) * whole(0, 2),
              happens(0.2) ? power(1e-4, 0.1) : 0,
              happens(0.2) ? uniform(0.002, 0.05) : 0,
              {}};
    const bool across = happens(0.7);
    const int rows = across ? 25 : 1;
    for (int i = 0; i < rows * std::min(period, 1000); ++i) n.value.push_back(uniform(0, 1));
    if (across && happens(0.5)) {
      // Most of it is the same in all rows.
      const double part = power(0.01, 0.5);
      const auto of_row = static_cast<std::size_t>(std::min(period, 1000));
      for (std::size_t i = of_row; i < n.value.size(); ++i) {
        n.value[i] = (1 - part) * n.value[i % of_row] + part * n.value[i];
      }
    }
    return [n, rows](int i, int j, int k) {
      const int row = rows == 1 ? 0 : (5 * k + j) % rows;
      const int at = (i + n.shift_y * j + n.shift_z * k) % n.period;
      const double own = n.value[static_cast<std::size_t>(row * std::min(n.period, 1000) + at)];
      const double wild = std::sin(12.9898 * i + 78.233 * j + 37.719 * k) * 43758.5453;
      return (own - 0.5) * (1 - 0.5 * (1 + std::cos(n.fade * i)) * (n.fade > 0 ? 1 : 0)) + 0.5 +
             n.noise * (wild - std::floor(wild) - 0.5);
    };
  }
  /// Returns values in [0, 1] of waves along x, of nine cells and more.
  std::function<double(int, int, int)> waves() {
    const double length = happens(0.5) ? one_of({9.0, 10.0, 12.0, 16.0, 24.0, 32.0}) : power(9, 60);
    const double second = happens(0.5) ? 0 : one_of({2.0, 3.0, 0.5});
    const double tilt_y = happens(0.6) ? 0 : uniform(-0.5, 0.5);
    const double tilt_z = happens(0.6) ? 0 : uniform(-0.5, 0.5);
    const double phase = uniform(0, 6.3);
    return [=](int i, int j, int k) {
      const double along = 2 * std::numbers::pi * (i + tilt_y * j + tilt_z * k) / length + phase;
      const double more =
          second * 2 * std::numbers::pi / length < 0.7 ? 0.3 * std::sin(second * along) : 0;
      return 0.5 + 0.35 * std::sin(along) + 0.5 * more;
    };
  }

  template <class Value>
  Scene of_type(const std::array<int, 3>& along_x, double size, bool smooth = false) {
    const int axis = whole(0, 2);
    std::array<int, 3> values{};
    for (int a = 0; a < 3; ++a) {
      values[static_cast<std::size_t>((axis + a) % 3)] = along_x[static_cast<std::size_t>(a)];
    }
    Vec3<double> spacing{1, 1, 1};
    for (int a = 0; a < 3; ++a) {
      if (happens(0.3)) spacing[a] = power(0.2, 2);
    }
    const auto f = smooth ? waves() : pattern();
    const auto value = [&](int i, int j, int k) {
      const int at[3] = {i, j, k};
      return size * f(at[axis], at[(axis + 1) % 3], at[(axis + 2) % 3]);
    };
    Vec3<double> origin;
    for (int a = 0; a < 3; ++a) {
      origin[a] = -0.5 * spacing[a] * (values[static_cast<std::size_t>(a)] - 1);
    }
    const auto volume =
        scenes::make_volume<Value>(scenes::grid_description(values, origin, spacing), value);
    const double longest = spacing[axis] * (along_x[0] - 1);
    Scene scene;
    scene.layers = {
        {VolumeContent{volume, smooth ? line(longest) : function(size, longest), nullptr}}};
    look(scene, axis, longest, spacing);
    return scene;
  }

  /// Returns a function that is linear over [0, 1], or has one corner.
  std::shared_ptr<const TransferFunction> line(double length) {
    const double extinction = power(0.3, 10) / length;
    scenes::Points points{{-0.1, uniform(0, 1) * extinction, random_color(1)}};
    if (happens(0.3)) {
      points.push_back({uniform(0.1, 0.9), uniform(0, 1) * extinction, random_color(1)});
    }
    points.push_back({1.1, uniform(0.5, 2) * extinction, random_color(1)});
    return scenes::transfer(std::move(points));
  }
  /// Returns a function over [0, size] of the data with an optical depth of 0.3 to 10 in all.
  std::shared_ptr<const TransferFunction> function(double size, double length) {
    const double extinction = power(0.3, 10) / length;
    scenes::Points points{{uniform(-0.2, 0.4) * size, happens(0.5) ? 0 : extinction,
                           random_color(happens(0.5) ? 1 : 2)}};
    const int more = happens(0.6) ? 0 : whole(1, 3);
    for (int i = 0; i < more; ++i) {
      points.push_back({points.back().value + power(0.01, 0.4) * size, uniform(0, 2) * extinction,
                        random_color(1)});
      if (happens(0.3)) {
        points.push_back({points.back().value, uniform(0, 2) * extinction, random_color(1)});
      }
    }
    points.push_back({points.back().value + power(0.05, 2) * size, uniform(0, 2) * extinction,
                      random_color(happens(0.5) ? 1 : 2)});
    return scenes::transfer(std::move(points));
  }

  void look(Scene& scene, int axis, double longest, const Vec3<double>& spacing) {
    Vec3<double> from{0, 0, 0};
    const double kind = uniform(0, 1);
    const bool along = kind < 0.6;
    if (along) {
      from[axis] = happens(0.5) ? -1 : 1;
      if (happens(0.3)) from = normalized(from + power(1e-4, 0.02) * direction());
    } else if (kind < 0.75) {
      from[(axis + 1) % 3] = 1;
    } else {
      from = direction();
    }
    Camera& camera = scene.camera;
    camera.focal_point = {0.013 * spacing.x, 0.021 * spacing.y, -0.017 * spacing.z};
    camera.position = camera.focal_point + (1.5 * longest + 5) * from;
    const int other = (axis + 2) % 3;
    camera.up = {0, 0, 0};
    camera.up[other] = 1;
    scene.size = {10, 10};
    if (happens(0.7)) {
      camera.projection = Projection::orthographic;
      camera.parallel_scale = along ? 0.9 * spacing[other] : 0.3 * longest;
    } else {
      camera.vertical_angle = along ? std::max(1e-3, 50 * spacing[other] / longest) : 20;
    }
  }

  std::mt19937 random_;
};

}  // namespace pellucid
