// SPDX-License-Identifier: Apache-2.0
//
// The sampling methods in packets of rays against the scalar ones, and what pre-integration is for.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "pellucid/cpu/render.h"
#include "pellucid/scene/defaults.h"
#include "tests/support/instruction_sets.h"
#include "tests/support/one_layer.h"

namespace pellucid::test_packet_sampler {
namespace {

/// `field` of the place in [0,1]³, times `scale`, in values of type T.
template <class T, class Field>
std::shared_ptr<const Volume> sampled(std::array<int, 3> n, Centering centering, double scale,
                                      const Field& field) {
  std::vector<T> values;
  for (int k = 0; k < n[2]; ++k) {
    for (int j = 0; j < n[1]; ++j) {
      for (int i = 0; i < n[0]; ++i) {
        values.push_back(
            static_cast<T>(scale * field(i / (n[0] - 1.0), j / (n[1] - 1.0), k / (n[2] - 1.0))));
      }
    }
  }
  Volume::Description description;
  description.dimensions = n;
  description.centering = centering;
  description.placement.spacing = {0.02, 0.03, 0.025};
  return std::make_shared<Volume>(description, VolumeData(DataArray<T>(std::move(values))));
}

/// A ball with waves in it, nothing around it.
double ball(double x, double y, double z) {
  const double r = std::hypot(x - 0.5, y - 0.45, z - 0.55);
  return std::max(0.0, 1 - 2.8 * r) * (0.8 + 0.2 * std::cos(30 * x));
}

Scene scene_of(std::shared_ptr<const Volume> volume, double scale) {
  Scene scene;
  test::volume_of(scene).volume = std::move(volume);
  test::volume_of(scene).transfer_function = std::make_shared<TransferFunction>(
      std::vector<TransferFunction::Point>{{0.15 * scale, 0, {1, 0.2, 0.1}},
                                           {0.3 * scale, 4, {0.9, 0.8, 0.1}},
                                           {0.5 * scale, 1, {0.1, 0.3, 1}},
                                           {0.9 * scale, 30, {0.2, 0.9, 0.4}}});
  scene.size = {45, 38};
  scene.camera = default_camera(*test::volume_of(scene).volume, scene.size);
  return scene;
}

float difference(const Image& a, const Image& b) {
  float largest = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    for (std::size_t c = 0; c < 4; ++c) {
      largest = std::max(largest, std::fabs(a.pixels[i][c] - b.pixels[i][c]));
    }
  }
  return largest;
}

/// How many steps there are where something absorbs everywhere.
std::uint64_t steps_of(Scene scene) {
  test::volume_of(scene).transfer_function = std::make_shared<TransferFunction>(
      std::vector<TransferFunction::Point>{{0, 1e-6, {1, 1, 1}}});
  RenderReport report;
  report = render(scene).report;
  return report.cells;
}

/// Packets against one ray after the other; whether blocks are jumped over.
void expect_same_in_packets(Scene scene, bool skips, const std::string& what) {
  for (const Method method : {Method::midpoint, Method::preintegrated}) {
    for (const double step : {0.3, 1.0, 3.5}) {
      scene.integration.method = method;
      scene.integration.step = step;
      RenderOptions options;
      options.machine.instruction_set = InstructionSet::scalar;
      const std::uint64_t steps = skips ? steps_of(scene) : 0;
      const auto [scalar, one] = render(scene, options);
      for (const InstructionSet set : packet_sets) {
        if (!test::runs_here(set)) continue;
        options.machine.instruction_set = set;
        const auto [image, packets] = render(scene, options);
        const std::string where = what + ", " + std::string(method_name(method)) + ", step " +
                                  std::to_string(step) + ", " + name_of(set);
        EXPECT_LE(difference(scalar, image), 1e-5f) << where;
        EXPECT_GT(packets.cells, 0u) << where;
        if (skips) {
          EXPECT_LT(packets.cells, steps * 4 / 5) << where;
          EXPECT_LT(one.cells, steps * 4 / 5) << where;
        }
      }
    }
  }
}

TEST(PacketSampler, GivesWhatRaysOneByOneGive) {
  const std::array<int, 3> n{45, 38, 51};
  for (const Centering centering : {Centering::point, Centering::cell}) {
    expect_same_in_packets(scene_of(sampled<float>(n, centering, 1, ball), 1), true, "f32");
    expect_same_in_packets(scene_of(sampled<double>(n, centering, 1, ball), 1), true, "f64");
    expect_same_in_packets(scene_of(sampled<std::uint8_t>(n, centering, 250, ball), 250), true,
                           "u8");
    expect_same_in_packets(scene_of(sampled<std::int16_t>(n, centering, 3e4, ball), 3e4), true,
                           "i16");
    expect_same_in_packets(scene_of(sampled<std::uint32_t>(n, centering, 4e9, ball), 4e9), true,
                           "u32");
  }
}

TEST(PacketSampler, GivesTheSameWhereNothingCanBeSkipped) {
  Scene scene = scene_of(sampled<float>({20, 33, 2}, Centering::point, 1,
                                        [](double x, double y, double) { return x * y; }),
                         1);
  test::volume_of(scene).transfer_function = std::make_shared<TransferFunction>(
      std::vector<TransferFunction::Point>{{0.0, 0.1, {1, 0.2, 0.1}},
                                           {0.5, 8, {0.9, 0.8, 0.1}},
                                           {0.5, 2, {0.1, 0.8, 0.1}},
                                           {1.0, 0.2, {0.1, 0.3, 1}}});
  expect_same_in_packets(scene, false, "sheet");
}

/// In light of both kinds of gradients, from lights of all kinds, with a factor of the extinction.
TEST(PacketSampler, ShadesAsRaysOneByOneDo) {
  for (const Centering centering : {Centering::point, Centering::cell}) {
    for (const GradientKind kind : {GradientKind::smooth, GradientKind::field}) {
      Scene scene = scene_of(sampled<std::uint8_t>({25, 28, 21}, centering, 250, ball), 250);
      Layer& layer = scene.layers[0];
      layer.shading = Shading{0.2, 0.7, 0.3, 12, kind, 0.02};
      scene.lights = {Light{},
                      {DirectionalLight{{1, 2, -1}}, {0.5, 0.25, 0.75}},
                      {PointLight{{0.9, 0.1, 0.3}}, {0.3, 0.6, 0.2}}};
      const std::string name = kind == GradientKind::smooth ? "smooth" : "field";
      expect_same_in_packets(scene, false, name);
      layer.gradient_opacity = std::make_shared<const GradientOpacity>(
          std::vector<GradientOpacity::Point>{{0, 0.1}, {300, 0.7}, {900, 1}});
      expect_same_in_packets(scene, false, name + ", gradient opacity");
    }
  }
}

TEST(PacketSampler, LeavesWhatItCannotDoToTheScalarSampler) {
  const auto holes = [](double x, double y, double z) {
    return x > 0.5 ? std::numeric_limits<double>::quiet_NaN() : ball(x, y, z);
  };
  expect_same_in_packets(scene_of(sampled<float>({25, 18, 21}, Centering::cell, 1, holes), 1),
                         false, "NaN");
}

TEST(Preintegrated, IsExactOnLinearDataUpToItsTable) {
  const InstructionSet packets = test::narrowest_set();
  if (packets == InstructionSet::scalar) GTEST_SKIP() << "no packets";
  Scene scene = scene_of(
      sampled<float>({33, 33, 33}, Centering::point, 1, [](double x, double, double) { return x; }),
      1);
  test::volume_of(scene).transfer_function =
      std::make_shared<TransferFunction>(std::vector<TransferFunction::Point>{
          {0.4, 0, {1, 0.5, 0.25}}, {0.43, 60, {1, 0.5, 0.25}}, {0.46, 0, {1, 0.5, 0.25}}});
  scene.integration.tolerance = 1e-6;
  const Image exact = render(scene).image;
  scene.integration.step = 4;
  scene.integration.method = Method::midpoint;
  EXPECT_GT(difference(render(scene).image, exact), 0.1f);
  scene.integration.method = Method::preintegrated;
  for (const InstructionSet set : {InstructionSet::scalar, packets}) {
    RenderOptions options;
    options.machine.instruction_set = set;
    EXPECT_LT(difference(render(scene, options).image, exact), 3e-3f) << name_of(set);
  }
}

TEST(Preintegrated, SeesTheAbsorptionInsideOfAStep) {
  // One step through a dense ramp of two colors: what lies in front hides what lies behind.
  Scene scene = scene_of(
      sampled<float>({33, 33, 33}, Centering::point, 1, [](double x, double, double) { return x; }),
      1);
  test::volume_of(scene).transfer_function = std::make_shared<TransferFunction>(
      std::vector<TransferFunction::Point>{{0.0, 20, {1, 0, 0}}, {1.0, 20, {0, 0, 1}}});
  scene.integration.tolerance = 1e-6;
  const Image exact = render(scene).image;
  scene.integration.method = Method::preintegrated;
  scene.integration.step = 8;
  EXPECT_LT(difference(render(scene).image, exact), 1e-2f);
}

TEST(Preintegrated, ErrorFallsWithTheStep) {
  Scene scene = scene_of(sampled<float>({45, 38, 51}, Centering::point, 1, ball), 1);
  scene.integration.tolerance = 1e-6;
  const Image exact = render(scene).image;
  scene.integration.method = Method::preintegrated;
  for (const Precision precision : {Precision::automatic, Precision::float64}) {
    scene.integration.precision = precision;
    float last = 1;
    for (const double step : {4.0, 1.0, 0.25}) {
      scene.integration.step = step;
      const float error = difference(render(scene).image, exact);
      EXPECT_LT(error, 0.5f * last) << step;
      last = error;
    }
    EXPECT_LT(last, 3e-3f);
  }
}

}  // namespace
}  // namespace pellucid::test_packet_sampler
