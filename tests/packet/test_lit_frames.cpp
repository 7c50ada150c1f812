// SPDX-License-Identifier: Apache-2.0
//
// Packets in light against the general path, which is in double and one ray at a time.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "ray_tracer.h"
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
  const bool surfaces = unit(random) < 0.4;
  Layer layer{VolumeContent{any_volume(random, kind, surfaces ? 0 : 0.01), scenes::transfer(points),
                            nullptr}};
  if (surfaces) layer.isosurfaces = random_surfaces(random);
  const double look = unit(random);
  if (look < 0.8) layer.shading = random_shading(random);
  if (look > 0.5) layer.gradient_opacity = random_factor(random);
  Scene scene;
  scene.layers = {layer};
  look_at_data(scene, random);
  return scene;
}

/// PELLUCID_TEST_SCENES sets how many scenes there are, PELLUCID_TEST_SEED where they begin.
TEST(LitFrames, AreWithinWhatTheySayOfTheGeneralPath) {
  if (no_packets()) GTEST_SKIP() << "this machine has none of the instruction sets of packets";
  const char* const wanted = std::getenv("PELLUCID_TEST_SCENES");
  const char* const seed = std::getenv("PELLUCID_TEST_SEED");
  const int count = wanted != nullptr ? std::atoi(wanted) : 64;
  const int first = seed != nullptr ? std::atoi(seed) : 0;
  std::uint64_t scalar_fallback = 0, panels = 0;
  std::size_t pixels = 0;
  for (int n = first; n < first + count; ++n) {
    std::mt19937 random(static_cast<unsigned>(n));
    Scene scene = random_scene(random, n % 4);
    scene.integration.tolerance = 1e-6;
    const Image truth = frame(scene, InstructionSet::scalar);
    for (const InstructionSet set : packet_sets) {
      if (!test::runs_here(set)) continue;
      for (const double tolerance : {2e-2, 2e-3, 1e-4}) {
        scene.integration.tolerance = tolerance;
        RenderReport report;
        const Image image = frame(scene, set, &report);
        scalar_fallback += report.spans.in_double;
        panels += report.spans.panels;
        SCOPED_TRACE(testing::Message() << "scene " << n << ", tolerance " << tolerance);
        for (const float error : image.error) ASSERT_LE(static_cast<double>(error), tolerance);
        expect_within_errors(image, truth, 1e-7);
        if (HasFatalFailure()) return;
        pixels += image.pixels.size();
      }
    }
  }
  if (wanted != nullptr) std::printf("%zu pixels\n", pixels);
  // They are what is tested: most pieces are not handed back.
  EXPECT_GT(panels, 5 * scalar_fallback);
}

/// Along the diagonal of a cell with a value at two corners and another at the others, whose data
/// turn half-way: an isosurface is as far from there as rounding moves data, or farther.
TEST(LitFrames, KnowWhetherDataReachAnIsosurface) {
  if (no_packets()) GTEST_SKIP() << "this machine has none of the instruction sets of packets";
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(0, 1);
  int met = 0, missed = 0;
  for (int n = 0; n < 40; ++n) {
    const auto ends = static_cast<float>(90 + 20 * unit(random));
    const auto others = static_cast<float>(140 + 20 * unit(random));
    const auto volume = scenes::make_volume<float>(
        scenes::grid_description({2, 2, 2}, {-0.5, -0.5, -0.5}), [&](int i, int j, int k) {
          return static_cast<double>((i + j + k) % 3 == 0 ? ends : others);
        });
    const double turn = 0.25 * static_cast<double>(ends) + 0.75 * static_cast<double>(others);
    const double off = std::pow(10, -6.5 + 2 * unit(random)) * (n % 2 == 0 ? 1 : -1);
    Layer layer{VolumeContent{volume, scenes::transfer({{80, 1, {1, 0, 0}}, {170, 1, {1, 1, 0}}}),
                              nullptr}};
    layer.isosurfaces = {{turn + off, 0.5, {0, 0, 1}}};
    // Where the data turn a head light has a kink.
    if (n % 4 >= 2) layer.shading = Shading{0.3, 0.7, 0, 1, GradientKind::field, 0.5};
    Scene scene;
    scene.layers = {layer};
    scene.camera.position = {10, 10, 10};
    scene.camera.focal_point = {0, 0, 0};
    scene.camera.vertical_angle = 1e-3;
    scene.size = {4, 4};
    scene.integration.tolerance = 1e-6;
    const Image truth = frame(scene, InstructionSet::scalar);
    scene.integration.tolerance = 1e-3;
    for (const InstructionSet set : packet_sets) {
      if (!test::runs_here(set)) continue;
      const Image image = frame(scene, set);
      for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const double said =
            static_cast<double>(image.error[i]) + static_cast<double>(truth.error[i]);
        ASSERT_NEAR(image.pixels[i][3], truth.pixels[i][3], said + 1e-7) << n << ' ' << off;
        ++(truth.pixels[i][3] > 0.85f ? met : missed);
      }
    }
  }
  EXPECT_GT(met, 100);
  EXPECT_GT(missed, 100);
}

TEST(LitFrames, HardlyEverLeaveRaysToTheGeneralPath) {
  if (no_packets()) GTEST_SKIP() << "this machine has none of the instruction sets of packets";
  std::mt19937 random(6);
  std::uniform_real_distribution<double> both(-1, 1);
  int left = 0, all = 0;
  for (int n = 0; n < 24; ++n) {
    const Scene scene = random_scene(random, n % 4);
    const Layer layer = moved_into_place(scene.layers[0]);
    RayTolerance wanted;
    wanted.tolerance = 1.0 / 512;
    const RenderOptions options;
    const Integration integration;
    const auto tracer =
        make_univariate_tracer({layer, integration, options, scene.lights, wanted, 1});
    if (tracer == nullptr) continue;
    std::vector<RayPart> parts;
    for (int k = 0; k < 300; ++k) {
      const Vec3<double> from{3 * both(random), 3 * both(random), 4};
      const Vec3<double> to{0.5 * both(random), 0.5 * both(random), 0.5 * both(random)};
      parts.push_back({{from, normalized(to - from)}});
    }
    for (const RayResult& found : tracer->trace(parts, {})) {
      ++all;
      if (found.status != RayStatus::followed) ++left;
    }
  }
  EXPECT_GT(all, 15 * 300);
  // Those that come to isosurfaces in cells with a jump of the function, above all.
  EXPECT_LT(left, all / 50) << all;
}

/// Data and light for which even binary64 has too few digits: what is handed back finds nothing
/// left of the budget. Its rays are left, and are then as good as one by one.
TEST(LitFrames, LeaveRaysThatHaveSpentTheirBudget) {
  if (no_packets()) GTEST_SKIP() << "this machine has none of the instruction sets of packets";
  const auto volume = scenes::make_volume<float>(
      scenes::grid_description({12, 12, 12}, {-1, -1, -1}, {0.18, 0.18, 0.18}),
      [](int i, int j, int k) { return 1e6 + 0.5 + 0.5 * std::sin(i + 0.7 * j - k); });
  Layer layer{VolumeContent{
      volume,
      scenes::transfer(
          {{1e6 + 0.1, 0, {1e4, 0, 0}}, {1e6 + 0.6, 3, {0, 1e4, 1}}, {1e6 + 0.9, 1, {0, 0, 1e4}}}),
      nullptr}};
  layer.shading = Shading{0.3, 0.7, 0.4, 30, GradientKind::smooth, 0.01};
  Scene scene;
  scene.layers = {layer};
  scene.camera.position = {3, 2, 4};
  scene.camera.focal_point = {0, 0, 0};
  scene.camera.vertical_angle = 25;
  scene.size = {4, 4};
  scene.integration.tolerance = 1e-4;
  RayTolerance wanted;
  wanted.tolerance = 1e-4;
  wanted.largest_color = largest_color(scene);
  const RenderOptions options;
  const auto tracer =
      make_univariate_tracer({layer, scene.integration, options, scene.lights, wanted, 1});
  ASSERT_NE(tracer, nullptr);
  const CameraFrame<double> camera = make_camera_frame(scene.camera, scene.size);
  std::vector<RayPart> parts;
  for (int i = 0; i < 16; ++i) parts.push_back({camera.ray(i % 4, i / 4)});
  int left = 0;
  for (const RayResult& found : tracer->trace(parts, {})) {
    if (found.status == RayStatus::left) ++left;
  }
  EXPECT_GT(left, 4);

  const Image one_by_one = frame(scene, InstructionSet::scalar);
  for (const InstructionSet set : packet_sets) {
    if (!test::runs_here(set)) continue;
    const Image packets = frame(scene, set);
    for (std::size_t i = 0; i < packets.pixels.size(); ++i) {
      EXPECT_LE(packets.error[i], 1.01f * one_by_one.error[i]) << i;
    }
  }
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
