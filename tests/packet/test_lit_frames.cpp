// SPDX-License-Identifier: Apache-2.0
//
// Packets in light against the general path, which is in double and one ray at a time.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>

#include "tests/packet/instruction_sets.h"
#include "tests/packet/lit_scenes.h"
#include "tests/support/instruction_sets.h"

namespace pellucid {
namespace {

Scene random_scene(std::mt19937& random, int kind) {
  std::uniform_real_distribution<double> unit(0, 1);
  const auto color = [&] { return random_color(random); };
  scenes::Points points{{60, 0, color()}, {100, 4 * unit(random), color()}};
  if (unit(random) < 0.5) {
    points.push_back({110, 0, color()});
    points.push_back({150, 0, color()});
    points.push_back({150, 2, color()});
  }
  points.push_back({200, 3 * unit(random), color()});
  Layer layer{VolumeContent{any_volume(random, kind, 0.01), scenes::transfer(points), nullptr}};
  layer.shading = random_shading(random);
  Scene scene;
  scene.layers = {layer};
  look_at_data(scene, random);
  return scene;
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
      if (!test::runs_here(set)) continue;
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
