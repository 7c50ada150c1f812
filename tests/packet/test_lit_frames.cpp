// SPDX-License-Identifier: Apache-2.0
//
// Packets in light against the general path, which is in double and one ray at a time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "pellucid/cpu/render.h"
#include "tests/packet/instruction_sets.h"
#include "tests/scenes/makers.h"

namespace pellucid {
namespace {

template <class Value>
scenes::VolumePointer random_volume(std::mt19937& random) {
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
    if (!std::is_integral_v<Value> && unit(random) < 0.01) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    return 200 * std::clamp(wave + noise * (unit(random) - 0.5), 0.0, 1.0);
  });
}

scenes::VolumePointer any_volume(std::mt19937& random, int kind) {
  switch (kind) {
    case 0:
      return random_volume<std::uint8_t>(random);
    case 1:
      return random_volume<std::int16_t>(random);
    case 2:
      return random_volume<std::uint16_t>(random);
    default:
      return random_volume<float>(random);
  }
}

Scene random_scene(std::mt19937& random, int kind) {
  std::uniform_real_distribution<double> unit(0, 1), both(-1, 1);
  const auto color = [&] { return Rgb<double>{unit(random), unit(random), unit(random)}; };
  scenes::Points points{{60, 0, color()}, {100, 4 * unit(random), color()}};
  if (unit(random) < 0.5) {
    points.push_back({110, 0, color()});
    points.push_back({150, 0, color()});
    points.push_back({150, 2, color()});
  }
  points.push_back({200, 3 * unit(random), color()});
  Layer layer{VolumeContent{any_volume(random, kind), scenes::transfer(points), nullptr}};
  layer.shading = Shading{0.3 * unit(random),
                          unit(random),
                          0.5 * unit(random),
                          1 + std::floor(40 * unit(random)),
                          unit(random) < 0.5 ? GradientKind::smooth : GradientKind::field,
                          unit(random) < 0.2 ? 0.0 : 0.05 * unit(random)};
  Scene scene;
  scene.layers = {layer};
  if (unit(random) < 0.5) {
    scene.lights = {{HeadLight{}, color()},
                    {DirectionalLight{{both(random), both(random), both(random)}}, color()}};
  }
  scene.camera.position = {3 * both(random), 3 * both(random), 4};
  scene.camera.focal_point = {0.3, 0.2, 0.1};
  scene.camera.vertical_angle = 35;
  scene.size = {12, 12};
  return scene;
}

Image frame(const Scene& scene, std::optional<InstructionSet> set, RenderReport* report = nullptr,
            int threads = 1) {
  RenderOptions options;
  options.error = true;
  options.threads = threads;
  options.instruction_set = set;
  return render(scene, options, report);
}

TEST(LitFrames, AreWithinWhatTheySayOfTheGeneralPath) {
  if (no_packets()) GTEST_SKIP() << "this machine has none of the instruction sets of packets";
  std::mt19937 random(3);
  std::uint64_t handed_back = 0, panels = 0;
  for (int n = 0; n < 48; ++n) {
    Scene scene = random_scene(random, n % 4);
    scene.integration.tolerance = 1e-6;
    const Image truth = frame(scene, InstructionSet::scalar);
    for (const InstructionSet set : sets) {
      if (!is_supported(set)) continue;
      for (const double tolerance : {2e-2, 2e-3, 1e-4}) {
        scene.integration.tolerance = tolerance;
        RenderReport report;
        const Image image = frame(scene, set, &report);
        handed_back += report.spans.in_double;
        panels += report.spans.panels;
        for (std::size_t i = 0; i < image.pixels.size(); ++i) {
          const double said =
              static_cast<double>(image.error[i]) + static_cast<double>(truth.error[i]);
          ASSERT_LE(static_cast<double>(image.error[i]), tolerance) << "scene " << n;
          for (std::size_t c = 0; c < 4; ++c) {
            ASSERT_NEAR(image.pixels[i][c], truth.pixels[i][c], said + 1e-7)
                << "scene " << n << ", tolerance " << tolerance << ", pixel " << i;
          }
        }
      }
    }
  }
  // They are what is tested: most pieces are not handed back.
  EXPECT_GT(panels, 10 * handed_back);
}

TEST(LitFrames, DoNotDependOnThreadsAndNeighbors) {
  std::mt19937 random(8);
  for (int n = 0; n < 4; ++n) {
    Scene scene = random_scene(random, n);
    scene.integration.tolerance = 1e-3;
    const Image one = frame(scene, std::nullopt), two = frame(scene, std::nullopt, nullptr, 2);
    EXPECT_EQ(one.pixels, two.pixels);
    EXPECT_EQ(one.error, two.error);
  }
}

}  // namespace
}  // namespace pellucid
