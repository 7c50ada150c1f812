// SPDX-License-Identifier: Apache-2.0
//
// The midpoint rule through several channels in packets of rays against the scalar one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "pellucid/cpu/render.h"
#include "pellucid/scene/defaults.h"
#include "tests/support/instruction_sets.h"
#include "tests/support/one_layer.h"

namespace pellucid::test_multivariate_sampler {
namespace {

/// The three fields of the scenes, in [0,1] over [0,1]³; the first is nothing over much of it.
double field(int which, double x, double y, double z) {
  if (which == 0) return std::max(0.0, 1 - 2.8 * std::hypot(x - 0.5, y - 0.45, z - 0.55));
  if (which == 1) return 0.5 + 0.5 * std::cos(9 * x + 4 * y * z);
  return x * y + (1 - x) * z;
}

/// The field, times `scale`, in values of type T; NaN in a corner where that is wanted.
template <class T>
Channel channel(int which, double scale, Centering centering, bool holes = false) {
  const std::array<int, 3> n{29, 38, 33};
  std::vector<T> values;
  for (int k = 0; k < n[2]; ++k) {
    for (int j = 0; j < n[1]; ++j) {
      for (int i = 0; i < n[0]; ++i) {
        const double v = field(which, i / (n[0] - 1.0), j / (n[1] - 1.0), k / (n[2] - 1.0));
        const bool hole = holes && i > n[0] / 2 && k < n[2] / 2;
        values.push_back(static_cast<T>(scale * (hole ? std::nan("") : v)));
      }
    }
  }
  Volume::Description description;
  description.dimensions = n;
  description.centering = centering;
  description.placement.spacing = {0.02, 0.03, 0.025};
  return {"channel " + std::to_string(which), "",
          std::make_shared<Volume>(description, VolumeData(DataArray<T>(std::move(values))))};
}

/// Primitives, the channels that it looks at, its center and widths by channel.
GaussianPrimitive primitive(std::vector<ChannelRef> channels, std::vector<double> center,
                            std::vector<double> widths, double extinction, Rgb<double> color) {
  GaussianPrimitive p;
  p.channels = std::move(channels);
  p.center = std::move(center);
  p.matrix = matrix_from_widths(widths);
  p.extinction = extinction;
  p.color = color;
  return p;
}

Scene scene_of(std::vector<Channel> channels, std::vector<GaussianPrimitive> primitives,
               std::vector<ChannelTransferFunction> tables = {}) {
  Scene scene;
  const int count = static_cast<int>(channels.size());
  test::channels_of(scene).channels = std::make_shared<Channels>(std::move(channels));
  test::channels_of(scene).transfer_function = std::make_shared<MultivariateTransferFunction>(
      count, std::move(primitives), std::move(tables));
  scene.size = {37, 30};
  scene.camera = default_camera(test::channels_of(scene).channels->grid(), scene.size);
  scene.integration.method = Method::midpoint;
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
  test::channels_of(scene).transfer_function = std::make_shared<MultivariateTransferFunction>(
      test::channels_of(scene).channels->count(), std::vector<GaussianPrimitive>{},
      std::vector<ChannelTransferFunction>{{0, TransferFunction({{0, 1e-6, {1, 1, 1}}})}});
  RenderReport report;
  report = render(scene).report;
  return report.cells;
}

/// Packets against one ray after the other; whether blocks are jumped over.
void expect_same_in_packets(Scene scene, bool skips, const std::string& what) {
  for (const double step : {0.3, 1.0, 3.5, 9.0}) {
    scene.integration.step = step;
    RenderOptions options;
    options.machine.instruction_set = InstructionSet::scalar;
    const std::uint64_t steps = skips ? steps_of(scene) : 0;
    const auto [scalar, one] = render(scene, options);
    EXPECT_GT(
        *std::max_element(scalar.pixels[15 * 37 + 18].begin(), scalar.pixels[15 * 37 + 18].end()),
        0.05f)
        << what << ": shows something";
    for (const InstructionSet set : packet_sets) {
      if (!test::runs_here(set)) continue;
      options.machine.instruction_set = set;
      const auto [image, packets] = render(scene, options);
      const std::string where = what + ", step " + std::to_string(step) + ", " + name_of(set);
      EXPECT_LE(difference(scalar, image), 1e-5f) << where;
      EXPECT_GT(packets.cells, 0u) << where;
      if (skips) {
        EXPECT_LT(packets.cells, steps * 9 / 10) << where;
      }
      options.machine.threads = 1;
      EXPECT_EQ(image.pixels, render(scene, options).image.pixels) << where;
      options.machine.threads = 0;
    }
  }
}

/// What absorbs in the ball alone.
std::vector<GaussianPrimitive> in_the_ball(double first, double second) {
  return {primitive({0}, {0.5 * first}, {0.1 * first}, 5, {1, 0.2, 0.1}),
          primitive({0, 1}, {0.3 * first, 0.6 * second}, {0.05 * first, 0.2 * second}, 9,
                    {0.1, 0.8, 1.5})};
}

TEST(MultivariateSampler, GivesWhatRaysOneByOneGive) {
  for (const Centering centering : {Centering::point, Centering::cell}) {
    const auto same = [&](Channel first, double of_first, Channel second, double of_second) {
      expect_same_in_packets(
          scene_of({std::move(first), std::move(second)}, in_the_ball(of_first, of_second)), true,
          centering == Centering::point ? "points" : "cells");
    };
    same(channel<float>(0, 1, centering), 1, channel<std::uint8_t>(1, 250, centering), 250);
    same(channel<std::int8_t>(0, 120, centering), 120, channel<double>(1, 1e3, centering), 1e3);
    same(channel<std::int16_t>(0, 3e4, centering), 3e4, channel<std::uint16_t>(1, 6e4, centering),
         6e4);
    same(channel<std::uint32_t>(0, 4e9, centering), 4e9, channel<std::int32_t>(1, 2e9, centering),
         2e9);
  }
}

TEST(MultivariateSampler, KnowsTurnedPrimitivesAndTables) {
  GaussianPrimitive turned;
  turned.channels = {2, 0};
  turned.center = {0.4, 0.5};
  turned.matrix = {{6, -2}, {3, 4}};
  turned.extinction = 6;
  turned.color = {0.2, 0.9, 0.3};
  const ChannelTransferFunction table{
      1, TransferFunction(
             {{0.3, 0, {1, 1, 0}}, {0.5, 3, {0, 1, 1}}, {0.5, 1, {0, 0, 1}}, {0.7, 0, {1, 0, 1}}})};
  expect_same_in_packets(
      scene_of({channel<float>(0, 1, Centering::cell), channel<float>(1, 1, Centering::cell),
                channel<float>(2, 1, Centering::cell)},
               {turned}, {table}),
      false, "turned");
}

TEST(MultivariateSampler, KeepsPrimitivesOfOtherBlocksApart) {
  // 70 in a row, more than there are bits in a set.
  std::vector<GaussianPrimitive> many;
  for (int i = 0; i < 70; ++i) {
    many.push_back(primitive({0}, {0.1 + 0.012 * i}, {0.006}, 4,
                             {i % 3 == 0 ? 1.0 : 0.1, i % 3 == 1 ? 1.0 : 0.1, 0.3}));
  }
  expect_same_in_packets(scene_of({channel<float>(0, 1, Centering::point)}, std::move(many)), true,
                         "many");
}

TEST(MultivariateSampler, TakesACellWithoutANumberInAnyChannelForVacuum) {
  for (const bool first : {true, false}) {
    Scene scene = scene_of({channel<float>(0, 1, Centering::cell, first),
                            channel<double>(1, 1, Centering::cell, !first)},
                           in_the_ball(1, 1));
    expect_same_in_packets(scene, true, "NaN");
  }
}

TEST(MultivariateSampler, LeavesWhatItCannotDoToTheScalarSampler) {
  // A primitive narrower than what binary32 tells apart in the data.
  Scene scene = scene_of({channel<double>(0, 1, Centering::point)},
                         {primitive({0}, {0.5}, {1e-5}, 5000, {1, 1, 1})});
  scene.integration.step = 0.5;
  RenderOptions options;
  const Image best = render(scene, options).image;
  options.machine.instruction_set = InstructionSet::scalar;
  EXPECT_EQ(best.pixels, render(scene, options).image.pixels);
  // Depth, and double precision.
  scene = scene_of({channel<float>(0, 1, Centering::point)},
                   {primitive({0}, {0.5}, {0.2}, 5, {1, 1, 1})});
  scene.integration.precision = Precision::float64;
  EXPECT_EQ(render(scene, {}).image.pixels, render(scene, options).image.pixels);
  scene.integration.precision = Precision::automatic;
  RenderOptions deep;
  deep.outputs.depth = true;
  const Image with_depth = render(scene, deep).image;
  deep.machine.instruction_set = InstructionSet::scalar;
  EXPECT_EQ(with_depth.depth, render(scene, deep).image.depth);
}

}  // namespace
}  // namespace pellucid::test_multivariate_sampler
