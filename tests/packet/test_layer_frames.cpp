// SPDX-License-Identifier: Apache-2.0
//
// Packets of several layers against the general path, which is in double and one ray at a time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "tests/packet/instruction_sets.h"
#include "tests/packet/lit_scenes.h"
#include "tests/packet/random_layers.h"
#include "tests/scenes/gallery.h"
#include "tests/scenes/grid_source.h"
#include "tests/scenes/layer_makers.h"
#include "tests/scenes/meshes.h"
#include "tests/support/instruction_sets.h"

namespace pellucid {
namespace {

int number(const char* name, int otherwise) {
  const char* const given = std::getenv(name);
  return given != nullptr ? std::atoi(given) : otherwise;
}

/// PELLUCID_TEST_SCENES sets how many scenes there are, PELLUCID_TEST_SEED where they begin.
TEST(LayerPackets, AreWithinWhatTheySayOfTheGeneralPath) {
  if (no_packets()) GTEST_SKIP() << "this machine has none of the instruction sets of packets";
  const int count = number("PELLUCID_TEST_SCENES", 40), first = number("PELLUCID_TEST_SEED", 1);
  std::uint64_t by_caller = 0, pieces = 0;
  std::size_t pixels = 0, over = 0, unknown = 0;
  for (int n = first; n < first + count; ++n) {
    SCOPED_TRACE(testing::Message() << "scene " << n);
    Scene scene = RandomLayers(static_cast<unsigned>(n)).scene();
    scene.integration.tolerance = 1e-6;
    const Image truth = frame(scene, InstructionSet::scalar);
    for (const InstructionSet set : packet_sets) {
      if (!test::runs_here(set)) continue;
      for (const double tolerance : {2e-2, 2e-3, 1e-4}) {
        scene.integration.tolerance = tolerance;
        RenderReport report;
        const Image image = frame(scene, set, &report);
        by_caller += report.spans.in_double;
        pieces += report.spans.panels + report.spans.closed;
        SCOPED_TRACE(testing::Message() << name_of(set) << ", tolerance " << tolerance);
        expect_within_errors(image, truth, 1e-7);
        if (HasFatalFailure()) return;
        for (std::size_t i = 0; i < image.pixels.size(); ++i) {
          const auto said = static_cast<double>(image.error[i]);
          const auto judge = static_cast<double>(truth.error[i]);
          ++pixels;
          if (!(judge <= 1e-5)) ++unknown;
          if (judge <= 1e-5 && !(said <= tolerance * (1 + 1e-6))) ++over;
        }
      }
    }
  }
  if (std::getenv("PELLUCID_TEST_SCENES") != nullptr) {
    std::printf("%zu pixels, %zu over, %zu not judged; %llu of %llu pieces by the caller\n", pixels,
                over, unknown, static_cast<unsigned long long>(by_caller),
                static_cast<unsigned long long>(pieces));
  }
  EXPECT_LT(over, pixels / 200);
  EXPECT_LT(unknown, pixels / 20);
  // They are what is tested.
  EXPECT_GT(pieces, 4 * by_caller);
}

/// The same scenes, whose volumes are fields of one's own: one ray at a time and in packets.
TEST(LayerPackets, AreTheSameOfFieldsOfOnesOwn) {
  const int count = number("PELLUCID_TEST_SCENES", 40), first = number("PELLUCID_TEST_SEED", 1);
  int sources = 0;
  for (int n = first; n < first + count; ++n) {
    SCOPED_TRACE(testing::Message() << "scene " << n);
    Scene scene = RandomLayers(static_cast<unsigned>(n)).scene();
    Scene own = scene;
    int of_scene = 0;
    for (Layer& layer : own.layers) {
      const auto* const volume = std::get_if<VolumeContent>(&layer.content);
      const bool has_channels = std::holds_alternative<ChannelsContent>(layer.content);
      if (!has_channels && (volume == nullptr || volume->mask)) continue;
      layer = scenes::as_source(layer);
      ++of_scene;
    }
    if (of_scene == 0) continue;
    sources += of_scene;
    scene.integration.tolerance = 1e-6;
    const Image truth = frame(scene, InstructionSet::scalar);
    for (const auto set :
         {std::optional(InstructionSet::scalar), std::optional<InstructionSet>()}) {
      for (const double tolerance : {2e-3, 1e-4}) {
        own.integration.tolerance = tolerance;
        const Image image = frame(own, set);
        SCOPED_TRACE(testing::Message() << (set ? "one by one" : "packets") << ' ' << tolerance);
        expect_within_errors(image, truth, 1e-7);
        if (HasFatalFailure()) return;
      }
    }
  }
  EXPECT_GT(sources, count / 4);
}

/// Two volumes of these numbers, in a world of this size: one of doubles, one of floats where these
/// hold them, in light.
Scene scene_of_size(double values, double world) {
  const auto points = [&](Rgb<double> color) {
    return scenes::transfer(
        {{0.2 * values, 0, color}, {0.6 * values, 2 / world, {1, 1, 1}}, {values, 0, color}});
  };
  Volume::Description description = scenes::grid_description(
      {7, 8, 6}, {-0.5 * world, -0.5 * world, -0.5 * world}, {world / 6, world / 7, world / 5});
  const auto field = [&](int i, int j, int k) {
    return values * (0.5 + 0.5 * std::sin(0.9 * i + 0.7 * j) * std::cos(0.8 * k));
  };
  Layer first{
      VolumeContent{scenes::make_volume<double>(description, field), points({1, 0, 0}), nullptr}};
  description.placement.origin.x += 0.2 * world;
  Layer second{
      VolumeContent{scenes::make_volume<float>(description, field), points({0, 0, 1}), nullptr}};
  second.shading = Shading{0.3, 0.7, 0.2, 10, GradientKind::smooth, 0.02};
  Scene scene;
  scene.layers = {first, second};
  scene.camera.position = {2 * world, 1.5 * world, 2 * world};
  scene.camera.focal_point = {0, 0, 0};
  scene.camera.vertical_angle = 30;
  scene.size = {6, 6};
  return scene;
}

TEST(LayerPackets, AreHonestBeyondWhatBinary32Holds) {
  if (no_packets()) GTEST_SKIP() << "this machine has none of the instruction sets of packets";
  double brightest = 0;
  for (const double values : {1e-30, 1e-14, 1e-8, 1e8, 1e14, 1e30}) {
    for (const double world : {1e-20, 1e-13, 1e-7, 1e7, 1e13, 1e20}) {
      Scene scene = scene_of_size(values, world);
      scene.integration.tolerance = 1e-6;
      const Image truth = frame(scene, InstructionSet::scalar);
      scene.integration.tolerance = 1e-3;
      for (const InstructionSet set : packet_sets) {
        if (!test::runs_here(set)) continue;
        const Image image = frame(scene, set);
        SCOPED_TRACE(testing::Message()
                     << name_of(set) << ", values of " << values << ", world of " << world);
        expect_within_errors(image, truth, 1e-7);
        if (HasFatalFailure()) return;
        for (const auto& pixel : image.pixels) brightest = std::max(brightest, double{pixel[3]});
      }
    }
  }
  EXPECT_GT(brightest, 0.3);
}

/// A cell is vacuum where any of its variables is, that of a table or not.
TEST(LayerPackets, KnowVacuumOfOtherVariables) {
  if (no_packets()) GTEST_SKIP() << "this machine has none of the instruction sets of packets";
  const auto description = scenes::grid_description({5, 5, 5}, {-1, -1, -1}, {0.5, 0.5, 0.5});
  const auto holes = scenes::make_volume<float>(
      description, [](int i, int j, int k) { return i == 2 && j + k > 3 ? std::nan("") : 0.5; });
  const auto whole = scenes::make_volume<float>(
      description, [](int i, int j, int k) { return 0.2 * i + 0.05 * j * k; });
  const auto channels = std::make_shared<const Channels>(
      std::vector<Channel>{{"holes", "", holes}, {"whole", "", whole}});
  const std::vector<ChannelTransferFunction> tables{
      {1, TransferFunction(scenes::Points{{0, 0.2, {1, 0, 0}}, {1, 2, {0, 1, 0}}})}};
  Scene scene;
  scene.layers = {{ChannelsContent{channels, std::make_shared<const MultivariateTransferFunction>(
                                                 2, std::vector<GaussianPrimitive>{}, tables)}}};
  scene.layers[0].shading = Shading{};
  scene.camera.position = {4, 3, 5};
  scene.camera.focal_point = {0, 0, 0};
  scene.camera.vertical_angle = 25;
  scene.size = {12, 12};
  scene.integration.tolerance = 1e-6;
  const Image truth = frame(scene, InstructionSet::scalar);
  scene.integration.tolerance = 2e-3;
  for (const InstructionSet set : packet_sets) {
    if (!test::runs_here(set)) continue;
    SCOPED_TRACE(name_of(set));
    expect_within_errors(frame(scene, set), truth, 1e-7);
  }
}

/// Light so bright that binary32 has too few digits for it, or almost: rays that spend too much go
/// the general way, and are as good as there.
TEST(LayerPackets, LeaveRaysThatSpendTooMuchToTheGeneralPath) {
  if (no_packets()) GTEST_SKIP() << "this machine has none of the instruction sets of packets";
  std::size_t good = 0;
  for (const double bright : {1.0, 10.0, 100.0}) {
    const auto layer = [&](double turn) {
      const auto volume = scenes::make_volume<float>(
          scenes::grid_description({9, 9, 9}, {-1, -1, -1}, {0.25, 0.25, 0.25}),
          [&](int i, int j, int k) { return 0.5 + 0.5 * std::sin(i + turn * j - k); });
      return Layer{VolumeContent{
          volume,
          scenes::transfer(
              {{0.4, 0, {bright, 0, 0}}, {0.6, 3, {0, bright, turn}}, {0.9, 1, {0, 0, bright}}}),
          nullptr}};
    };
    Scene scene;
    scene.layers = {layer(0.3), layer(0.8)};
    for (const double value : {0.3, 0.45, 0.62, 0.7, 0.81}) {
      scene.layers[0].isosurfaces.push_back({value, 0.2, {bright, bright, 0}});
    }
    scene.camera.position = {3, 2, 4};
    scene.camera.focal_point = {0, 0, 0};
    scene.camera.vertical_angle = 25;
    scene.size = {8, 8};
    scene.integration.tolerance = 1e-4;
    const Image one_by_one = frame(scene, InstructionSet::scalar);
    for (const InstructionSet set : packet_sets) {
      if (!test::runs_here(set)) continue;
      const Image packets = frame(scene, set);
      for (std::size_t i = 0; i < packets.pixels.size(); ++i) {
        if (!(one_by_one.error[i] <= 1e-4f)) continue;
        ++good;
        EXPECT_LE(packets.error[i], 1e-4f) << bright << ' ' << i;
        for (std::size_t c = 0; c < 4; ++c) {
          ASSERT_NEAR(packets.pixels[i][c], one_by_one.pixels[i][c],
                      packets.error[i] + one_by_one.error[i] + 1e-5f * one_by_one.pixels[i][c])
              << bright << ' ' << i;
        }
      }
    }
  }
  EXPECT_GT(good, 100U * static_cast<unsigned>(set_count()));
}

/// Slices in the faces of a volume, where rays enter it and where they leave the last layer.
TEST(LayerPackets, MeetSurfacesAtTheEndsOfRays) {
  if (no_packets()) GTEST_SKIP() << "this machine has none of the instruction sets of packets";
  int seen = 0;
  for (const double z : {-1.0, 1.0, 0.25}) {
    const auto layer = [](double move) {
      const auto volume = scenes::make_volume<float>(
          scenes::grid_description({5, 6, 4}, {-1, -1, -1}, {0.5, 0.4, 2.0 / 3}),
          [](int i, int j, int k) { return 100 + 60 * std::sin(i + j - k); });
      Layer result{VolumeContent{
          volume, scenes::transfer({{0, 0, {1, 0, 0}}, {150, 0.1, {0, 1, 0}}}), nullptr}};
      result.transform.translation = {move, 0, 0};
      return result;
    };
    Scene scene;
    scene.layers = {layer(0), layer(0.3)};
    scene.layers[0].slices = {{{0, 0, z}, {0, 0, 1}, 0.5}};
    scene.camera.position = {0.3, 0.2, 5};
    scene.camera.focal_point = {0, 0, 0};
    scene.camera.vertical_angle = 20;
    scene.size = {9, 9};
    scene.integration.tolerance = 1e-6;
    const Image truth = frame(scene, InstructionSet::scalar);
    scene.integration.tolerance = 1e-2;
    for (const InstructionSet set : packet_sets) {
      if (!test::runs_here(set)) continue;
      const Image image = frame(scene, set);
      for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        ASSERT_NEAR(image.pixels[i][3], truth.pixels[i][3], image.error[i] + truth.error[i] + 1e-7f)
            << name_of(set) << ", slice at " << z << ", pixel " << i;
        if (truth.pixels[i][3] > 0.5f) ++seen;
      }
    }
  }
  EXPECT_GT(seen, 100 * set_count());
}

/// A layer alone in front of another, with an isosurface or with a medium: rays that several ways
/// follow, one after the other.
TEST(LayerPackets, KnowWhereHalfOfTheOpacityIs) {
  int seen = 0;
  for (const double opacity : {0.0, 0.3, 0.45, 1.0}) {
    const double extinction = opacity > 0 ? 0 : 0.6;
    Layer front{VolumeContent{scenes::builtin("sphere", 16),
                              scenes::transfer({{0, 0, {1, 0, 0}}, {1, extinction, {0, 1, 0}}}),
                              nullptr}};
    if (opacity > 0) front.isosurfaces = {{0.5, opacity, {0, 0, 1}}};
    Layer behind{VolumeContent{scenes::builtin("shells", 16),
                               scenes::transfer({{0, 0.5, {0, 1, 0}}, {1, 2, {0, 1, 1}}}),
                               nullptr}};
    behind.transform.translation = {0, 0, -2.5};
    Scene scene;
    scene.layers = {front, behind};
    scene.camera.position = {0.4, 0.3, 6};
    scene.camera.focal_point = {0, 0, -1};
    scene.camera.vertical_angle = 25;
    scene.size = {32, 32};
    scene.integration.tolerance = 1e-4;
    RenderOptions options;
    options.machine.threads = 1;
    options.outputs.depth = true;
    const Image packets = render(scene, options).image;
    options.machine.instruction_set = InstructionSet::scalar;
    const Image truth = render(scene, options).image;
    for (std::size_t i = 0; i < packets.depth.size(); ++i) {
      if (!std::isfinite(truth.depth[i])) continue;
      ++seen;
      EXPECT_NEAR(packets.depth[i], truth.depth[i], 1e-3f) << opacity << ' ' << i;
    }
  }
  EXPECT_GT(seen, 1000);
}

/// The scenes of the tolerance matrix, each from one camera.
TEST(LayerPackets, AgreeWithTheGeneralPathOnTheGallery) {
  if (no_packets()) GTEST_SKIP() << "this machine has none of the instruction sets of packets";
  std::size_t camera = 0;
  for (const auto& gallery : {scenes::layer_gallery(), scenes::light_gallery()}) {
    for (const scenes::GalleryEntry& entry : gallery) {
      if (!entry.why_missing().empty()) continue;
      SCOPED_TRACE(entry.name);
      Scene scene = scenes::scene_of(entry.make(17), camera++ % 3, 17);
      scene.integration.tolerance = 1e-5;
      const Image truth = frame(scene, InstructionSet::scalar);
      scene.integration.tolerance = 1.0 / 512;
      const Image image = frame(scene, std::nullopt);
      expect_within_errors(image, truth, 1e-7);
      if (HasFatalFailure()) return;
    }
  }
}

TEST(LayerPackets, DoNotDependOnThreads) {
  for (unsigned n = 100; n < 108; ++n) {
    Scene scene = RandomLayers(n).scene();
    scene.integration.tolerance = 1e-3;
    const Image one = frame(scene, std::nullopt), two = frame(scene, std::nullopt, nullptr, 2);
    EXPECT_EQ(one.pixels, two.pixels) << n;
    EXPECT_EQ(one.error, two.error) << n;
  }
}

}  // namespace
}  // namespace pellucid
