// SPDX-License-Identifier: Apache-2.0
//
// Data that repeat along rays, against the reference: the errors of cells that are alike do not
// cancel. PELLUCID_TEST_SCENES sets how many scenes there are, PELLUCID_TEST_SEED where they begin.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>

#include "pellucid/cpu/render.h"
#include "tests/packet/instruction_sets.h"
#include "tests/packet/repeating_scenes.h"
#include "tests/scenes/reference_frame.h"
#include "tests/support/instruction_sets.h"

namespace pellucid {
namespace {

/// Pixels that were compared.
struct Compared {
  std::size_t pixels = 0, over = 0;  ///< `over`: that report more than the tolerance
  double largest_share = 0;          ///< of a difference in what is reported
};

void compare(Scene scene, std::initializer_list<double> tolerances, Compared& compared) {
  const scenes::ReferenceFrame truth = scenes::reference_frame(scene, 1);
  RenderOptions options;
  options.outputs.error = true;
  options.machine.threads = 1;
  for (const InstructionSet set : packet_sets) {
    if (!test::runs_here(set)) continue;
    options.machine.instruction_set = set;
    for (const double tolerance : tolerances) {
      scene.integration.tolerance = tolerance;
      const Image image = render(scene, options).image;
      for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const auto said = static_cast<double>(image.error[i]);
        double off = 0;
        for (std::size_t c = 0; c < 4; ++c) {
          off = std::max(off,
                         std::fabs(static_cast<double>(image.pixels[i][c]) - truth.pixels[i][c]));
        }
        ASSERT_LE(off, said + scenes::reference_accuracy * (1 + off))
            << "tolerance " << tolerance << ", pixel " << i;
        ++compared.pixels;
        if (said > tolerance) ++compared.over;
        if (said > 1e-6) compared.largest_share = std::max(compared.largest_share, off / said);
      }
    }
  }
}

void compare_many(unsigned count, std::initializer_list<double> tolerances,
                  const std::function<Scene(unsigned)>& make) {
  if (no_packets()) GTEST_SKIP() << "this machine has none of the instruction sets of packets";
  const char* const wanted = std::getenv("PELLUCID_TEST_SCENES");
  const char* const seed = std::getenv("PELLUCID_TEST_SEED");
  if (wanted != nullptr) count = static_cast<unsigned>(std::atoi(wanted));
  const unsigned first = seed != nullptr ? static_cast<unsigned>(std::atoi(seed)) : 1;
  Compared compared;
  for (unsigned n = first; n < first + count; ++n) {
    SCOPED_TRACE(testing::Message() << "scene " << n);
    compare(make(n), tolerances, compared);
    if (testing::Test::HasFatalFailure()) return;
  }
  EXPECT_LT(compared.over, compared.pixels / 100);
  testing::Test::RecordProperty("largest_share", std::to_string(compared.largest_share));
  if (wanted != nullptr) {
    std::printf(
        "%zu pixels, %zu of them report more than the tolerance; largest error %.3g of it\n",
        compared.pixels, compared.over, compared.largest_share);
  }
}

TEST(RepeatingFrames, InLightAreWithinWhatTheySay) {
  compare_many(12, {1.0 / 512, 2e-4}, [](unsigned seed) { return RepeatingScenes(seed).lit(); });
}

TEST(RepeatingFrames, OfSmoothDataAreWithinWhatTheySay) {
  compare_many(12, {1e-2, 2e-4}, [](unsigned seed) { return RepeatingScenes(seed).smooth(); });
}

/// Scenes of the search that were further off than they said: by six nodes (206, 1066), data of two
/// planes in turn (408, 501), narrow highlights (1384, 1623), and kinks in highlights (139, 628).
TEST(RepeatingFrames, ThatWereOffAreNot) {
  if (no_packets()) GTEST_SKIP() << "this machine has none of the instruction sets of packets";
  Compared compared;
  for (const unsigned seed : {139U, 206U, 408U, 501U, 628U, 1066U, 1384U, 1623U}) {
    SCOPED_TRACE(testing::Message() << "scene " << seed);
    compare(RepeatingScenes(seed).lit(), {1.0 / 512, 2e-4}, compared);
  }
}

/// Gradients of the field jump at faces, and rays in planes of faces may have those of either side:
/// along the axes and diagonals of a grid, in a medium and on isosurfaces.
TEST(FieldGradients, AlongFacesAreWithinWhatTheySay) {
  const auto volume = scenes::make_volume<float>(
      scenes::grid_description({9, 9, 9}, {-1, -1, -1}, {0.25, 0.25, 0.25}),
      [](int i, int j, int k) {
        return 0.5 + 0.4 * std::sin(1.3 * i + 0.9 * j * k) * std::cos(0.7 * k + 1.1 * j);
      });
  int doubtful = 0;
  for (const GradientKind kind : {GradientKind::field, GradientKind::smooth}) {
    for (const bool surface : {false, true}) {
      Layer layer{VolumeContent{volume,
                                scenes::transfer({{0, surface ? 0.0 : 0.3, {0.2, 0.5, 1}},
                                                  {1, surface ? 0.0 : 2, {1, 1, 0.3}}}),
                                nullptr}};
      layer.shading = Shading{};
      layer.shading->gradient = kind;
      if (surface) layer.isosurfaces = {{0.5, 0.7, {1, 0.8, 0.6}}};
      for (const Vec3<double>& along : {Vec3<double>{0, 0, -1}, Vec3<double>{1, 0, 0},
                                        Vec3<double>{0, 1, 0}, Vec3<double>{1, 1, 0}}) {
        Scene scene;
        scene.layers = {layer};
        scene.lights = {{HeadLight{}, {1, 1, 1}},
                        {DirectionalLight{{0.3, -0.6, 0.7}}, {0.5, 1, 0.8}}};
        scene.camera.projection = Projection::orthographic;
        scene.camera.focal_point = {0, 0, 0};
        scene.camera.position = along * -4.0;
        scene.camera.up = along.z == 0 ? Vec3<double>{0, 0, 1} : Vec3<double>{0, 1, 0};
        // Rays a quarter apart, all but those along a diagonal in two planes of faces.
        scene.size = {7, 7};
        scene.camera.parallel_scale = 0.875;
        scene.integration.tolerance = 1e-4;
        const scenes::ReferenceFrame truth = scenes::reference_frame(scene, 1);
        RenderOptions options;
        options.outputs.error = true;
        options.machine.threads = 1;
        for (const InstructionSet set : instruction_sets) {
          if (!test::runs_here(set)) continue;
          options.machine.instruction_set = set;
          const Image image = render(scene, options).image;
          for (std::size_t i = 0; i < image.pixels.size(); ++i) {
            const auto said = static_cast<double>(image.error[i]);
            if (said > scene.integration.tolerance) ++doubtful;
            if (kind == GradientKind::smooth) {
              ASSERT_LE(said, scene.integration.tolerance);
            }
            for (std::size_t c = 0; c < 4; ++c) {
              ASSERT_NEAR(image.pixels[i][c], truth.pixels[i][c], said + 1e-9)
                  << "pixel " << i << ", along " << along.x << ", " << along.y << ", " << along.z;
            }
          }
        }
      }
    }
  }
  EXPECT_GT(doubtful, 100);
}

}  // namespace
}  // namespace pellucid
