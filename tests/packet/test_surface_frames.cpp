// SPDX-License-Identifier: Apache-2.0
//
// Isosurfaces in packets against the reference.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>
#include <random>
#include <vector>

#include "pellucid/reference/render.h"
#include "ray_tracer.h"
#include "tests/packet/instruction_sets.h"
#include "tests/packet/lit_scenes.h"
#include "tests/support/instruction_sets.h"

namespace pellucid {
namespace {

/// Up to five surfaces, some of them opaque, lit or not, some of them clipped.
Scene random_scene(std::mt19937& random, int kind) {
  std::uniform_real_distribution<double> unit(0, 1);
  Layer layer{
      VolumeContent{any_volume(random, kind, 0), scenes::transfer({{0, 0, {0, 0, 0}}}), nullptr}};
  const int count = 1 + static_cast<int>(5 * unit(random));
  for (int n = 0; n < count; ++n) {
    // Between the values of integers, and at them.
    const double value = unit(random) < 0.2 ? 20 + 30 * n : 20 + 30 * (n + unit(random));
    layer.isosurfaces.push_back(
        {value, unit(random) < 0.3 ? 1 : unit(random), random_color(random)});
  }
  if (unit(random) < 0.7) layer.shading = random_shading(random);
  if (unit(random) < 0.3) layer.clips = {{ClipBox{{-0.8, -0.7, -0.9}, {0.3, 0.4, 0.5}}}};
  Scene scene;
  scene.layers = {layer};
  look_at_data(scene, random);
  return scene;
}

TEST(SurfaceFrames, AreWithinWhatTheySayOfTheReference) {
  if (no_packets()) GTEST_SKIP() << "this machine has none of the instruction sets of packets";
  std::mt19937 random(5);
  int opaque = 0;
  for (int n = 0; n < 40; ++n) {
    Scene scene = random_scene(random, n % 4);
    RenderOptions with_depth;
    with_depth.outputs.depth = true;
    const Image truth = render_reference(scene, with_depth).image;
    for (const InstructionSet set : packet_sets) {
      if (!test::runs_here(set)) continue;
      for (const double tolerance : {2e-2, 2e-3, 1e-4}) {
        scene.integration.tolerance = tolerance;
        RenderOptions options;
        options.outputs.error = options.outputs.depth = true;
        options.machine.threads = 1;
        options.machine.instruction_set = set;
        const Image image = render(scene, options).image;
        for (std::size_t i = 0; i < image.pixels.size(); ++i) {
          const auto said = static_cast<double>(image.error[i]);
          ASSERT_LE(said, tolerance) << "scene " << n << ", pixel " << i;
          for (std::size_t c = 0; c < 4; ++c) {
            ASSERT_NEAR(image.pixels[i][c], truth.pixels[i][c], said + 1e-7)
                << "scene " << n << ", tolerance " << tolerance << ", pixel " << i;
          }
          if (truth.pixels[i][3] < 1) continue;
          ++opaque;
          ASSERT_NEAR(image.depth[i], truth.depth[i], 1e-4) << "scene " << n << ", pixel " << i;
        }
      }
    }
  }
  EXPECT_GT(opaque, 1000);
}

TEST(SurfaceFrames, HardlyEverLeaveRaysToTheGeneralPath) {
  if (no_packets()) GTEST_SKIP() << "this machine has none of the instruction sets of packets";
  std::mt19937 random(6);
  std::uniform_real_distribution<double> both(-1, 1);
  int left = 0, all = 0;
  for (int n = 0; n < 16; ++n) {
    const Scene scene = random_scene(random, n % 4);
    const Layer layer = moved_into_place(scene.layers[0]);
    RayTolerance wanted;
    wanted.tolerance = 1.0 / 512;
    const RenderOptions options;
    const Integration integration;
    const auto tracer = make_surface_tracer({layer, integration, options, scene.lights, wanted, 1});
    ASSERT_NE(tracer, nullptr);
    std::vector<RayPart> parts;
    for (int k = 0; k < 300; ++k) {
      const Vec3<double> from{3 * both(random), 3 * both(random), 4};
      const Vec3<double> to{0.5 * both(random), 0.5 * both(random), 0.5 * both(random)};
      parts.push_back({{from, normalized(to - from)}});
    }
    for (const RayResult& found : tracer->trace(parts, {})) {
      ++all;
      if (std::isinf(found.error)) ++left;
    }
  }
  EXPECT_LT(left, all / 100) << all;
}

TEST(SurfaceFrames, AreOfPlainIsosurfacesAlone) {
  std::mt19937 random(7);
  const RayTolerance wanted = [] {
    RayTolerance t;
    t.tolerance = 1e-3;
    return t;
  }();
  const auto made = [&](const std::function<void(Layer&, RayTolerance&)>& change) {
    Layer layer{
        VolumeContent{any_volume(random, 3, 0), scenes::transfer({{0, 0, {0, 0, 0}}}), nullptr}};
    layer.isosurfaces = {{100, 1, {1, 1, 1}}};
    RayTolerance own = wanted;
    change(layer, own);
    return make_surface_tracer({layer, {}, {}, {}, own, 1}) != nullptr;
  };
  EXPECT_EQ(made([](Layer&, RayTolerance&) {}), !no_packets());
  EXPECT_FALSE(made([](Layer& layer, RayTolerance&) { layer.slices = {{}}; }));
  EXPECT_FALSE(made([](Layer&, RayTolerance& own) { own.grade = Grade::proved; }));
  EXPECT_FALSE(made([](Layer&, RayTolerance& own) { own.tolerance = 1e-6; }));
  EXPECT_FALSE(made([&](Layer& layer, RayTolerance&) {
    std::get<VolumeContent>(layer.content).volume = any_volume(random, 3, 0.05);
  }));
  EXPECT_FALSE(made([](Layer& layer, RayTolerance&) {
    std::get<VolumeContent>(layer.content).transfer_function = scenes::transfer({{0, 1, {}}});
  }));
  EXPECT_FALSE(made([](Layer& layer, RayTolerance&) {
    layer.isosurfaces[0].colors = scenes::transfer({{0, 1, {}}});
  }));
}

}  // namespace
}  // namespace pellucid
