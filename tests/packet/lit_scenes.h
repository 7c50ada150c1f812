// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <type_traits>
#include <vector>

#include "pellucid/cpu/render.h"
#include "tests/scenes/makers.h"

namespace pellucid {

inline Rgb<double> random_color(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  return {unit(random), unit(random), unit(random)};
}

inline Shading random_shading(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  return {0.3 * unit(random),
          unit(random),
          0.5 * unit(random),
          1 + std::floor(40 * unit(random)),
          unit(random) < 0.5 ? GradientKind::smooth : GradientKind::field,
          unit(random) < 0.2 ? 0.0 : 0.05 * unit(random)};
}

/// Of gradients of data up to 200: none, few or many of them show.
inline std::shared_ptr<const GradientOpacity> random_factor(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<GradientOpacity::Point> points;
  double gradient = unit(random) < 0.5 ? 0 : 30 * unit(random);
  for (int n = 0; n < 2 + static_cast<int>(4 * unit(random)); ++n) {
    points.push_back({gradient, unit(random) < 0.3 ? 0 : 1.5 * unit(random)});
    gradient += (unit(random) < 0.3 ? 3 : 60) * (0.01 + unit(random));
  }
  const auto unit_of_length =
      unit(random) < 0.7 ? GradientOpacity::Unit::voxel : GradientOpacity::Unit::world;
  return std::make_shared<const GradientOpacity>(points, unit_of_length);
}

/// Up to four of data up to 200, some of them opaque.
inline std::vector<Isosurface> random_surfaces(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Isosurface> surfaces;
  for (int n = 0; n < 1 + static_cast<int>(4 * unit(random)); ++n) {
    // Between the values of integers, at them, and at control points.
    const double value = unit(random) < 0.2 ? 30 + 40 * n : 30 + 40 * (n + unit(random));
    surfaces.push_back({value, unit(random) < 0.2 ? 1 : 0.7 * unit(random), random_color(random)});
  }
  return surfaces;
}

template <class Value>
scenes::VolumePointer random_volume(std::mt19937& random, double vacuum) {
  std::uniform_real_distribution<double> unit(0, 1);
  const auto count = [&] { return 2 + static_cast<int>(20 * unit(random)); };
  Volume::Description description =
      scenes::grid_description({count(), count(), count()}, {-1, -1, -1});
  description.placement.spacing = {0.1 + 0.1 * unit(random), 0.1 + 0.1 * unit(random),
                                   0.1 + 0.1 * unit(random)};
  description.placement.direction = {
      {{0.8, 0.6, 0.1}, {-0.6, 0.8, 0.2 * unit(random)}, {0, 0.1, 1}}};
  if (unit(random) < 0.5) description.centering = Centering::cell;
  const double a = unit(random), b = 2 * unit(random), noise = unit(random) < 0.5 ? 0.3 : 0.01;
  return scenes::make_volume<Value>(description, [&](int i, int j, int k) {
    const double wave = 0.5 + 0.3 * std::sin(a * i + b * j) * std::cos(0.5 * k + a);
    if (!std::is_integral_v<Value> && unit(random) < vacuum) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    return 200 * std::clamp(wave + noise * (unit(random) - 0.5), 0.0, 1.0);
  });
}

/// Of one of four types, in a random place. `vacuum`: the share of values that are NaN.
inline scenes::VolumePointer any_volume(std::mt19937& random, int kind, double vacuum) {
  switch (kind) {
    case 0:
      return random_volume<std::uint8_t>(random, vacuum);
    case 1:
      return random_volume<std::int16_t>(random, vacuum);
    case 2:
      return random_volume<std::uint16_t>(random, vacuum);
    default:
      return random_volume<float>(random, vacuum);
  }
}

/// From a random place, in random lights.
inline void look_at_data(Scene& scene, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1), both(-1, 1);
  if (unit(random) < 0.5) {
    scene.lights = {
        {HeadLight{}, random_color(random)},
        {DirectionalLight{{both(random), both(random), both(random)}}, random_color(random)}};
  }
  if (unit(random) < 0.5) {
    // Among the data, beside them or far away.
    const double far = std::pow(10, -0.3 + 3 * unit(random));
    if (unit(random) < 0.5) scene.lights.clear();
    scene.lights.push_back(
        {PointLight{{far * both(random), far * both(random), far * both(random)}},
         random_color(random)});
  }
  scene.camera.position = {3 * both(random), 3 * both(random), 4};
  scene.camera.focal_point = {0.3, 0.2, 0.1};
  scene.camera.vertical_angle = 35;
  scene.size = {12, 12};
}

inline Image frame(const Scene& scene, std::optional<InstructionSet> set,
                   RenderReport* report = nullptr, int threads = 1) {
  RenderOptions options;
  options.outputs.error = true;
  options.machine.threads = threads;
  options.machine.instruction_set = set;
  RenderResult result = render(scene, options);
  if (report != nullptr) *report = std::move(result.report);
  return std::move(result.image);
}

/// Expects each channel of each pixel within what both frames say, and `beside`. Ends at the first
/// one that is not.
inline void expect_within_errors(const Image& image, const Image& truth, double beside) {
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const double said = static_cast<double>(image.error[i]) + static_cast<double>(truth.error[i]);
    for (std::size_t c = 0; c < 4; ++c) {
      ASSERT_NEAR(image.pixels[i][c], truth.pixels[i][c], said + beside) << "pixel " << i;
    }
  }
}

}  // namespace pellucid
