// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "pellucid/cpu/render.h"
#include "pellucid/reference/render.h"
#include "pellucid/scene/defaults.h"
#include "tests/support/instruction_sets.h"
#include "tests/support/one_layer.h"

namespace pellucid {
namespace {

/// Waves and some noise, on n³ values.
std::shared_ptr<const Volume> waves(int n, double frequency, double noise, bool vacuum,
                                    bool rectilinear, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  Volume::Description description;
  description.dimensions = {n, n, n};
  if (rectilinear) {
    for (int i = 0; i < n; ++i) description.coordinates[1].push_back(i + 0.03 * i * i);
  }
  std::vector<float> values;
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const double wave = std::sin(frequency * (i + 0.7 * j - 0.4 * k));
        values.push_back(static_cast<float>(0.5 + 0.4 * wave + noise * unit(random)));
      }
    }
  }
  if (vacuum) {
    for (int i = 0; i < n; ++i) {
      values[random() % values.size()] = std::numeric_limits<float>::quiet_NaN();
    }
  }
  return std::make_shared<Volume>(description, VolumeData(DataArray<float>(values)));
}

struct Kind {
  std::string name;
  int points = 12, channels = 1, primitives = 3;
  double width = 0.05, extinction = 1, noise = 0;
  bool vacuum = false, table = false;
};

Scene make_scene(const Kind& kind, bool rectilinear) {
  Scene scene;
  std::vector<Channel> channels;
  for (int c = 0; c < kind.channels; ++c) {
    channels.push_back({std::to_string(c), "",
                        waves(kind.points, 0.3 + 0.2 * c, kind.noise, kind.vacuum, rectilinear,
                              static_cast<unsigned>(c))});
  }
  std::vector<GaussianPrimitive> primitives;
  for (int p = 0; p < kind.primitives; ++p) {
    GaussianPrimitive g;
    for (int c = 0; c < kind.channels; ++c) {
      g.channels.push_back(c);
      g.center.push_back((p + 0.5) / kind.primitives);
    }
    g.matrix = matrix_from_widths(std::vector<double>(g.channels.size(), kind.width));
    g.extinction = kind.extinction;
    g.color = {p % 3 == 0 ? 1.0 : 0.1, p % 3 == 1 ? 1.0 : 0.1, p % 3 == 2 ? 1.0 : 0.1};
    primitives.push_back(g);
  }
  std::vector<ChannelTransferFunction> tables;
  if (kind.table) {
    tables.push_back(
        {0, TransferFunction({{0.2, 0, {1, 1, 1}}, {0.3, 0.2, {1, 0, 1}}, {0.4, 0, {}}})});
  }
  test::channels_of(scene).channels = std::make_shared<Channels>(channels);
  test::channels_of(scene).transfer_function =
      std::make_shared<MultivariateTransferFunction>(kind.channels, primitives, tables);
  scene.size = {20, 20};
  scene.camera = default_camera(test::channels_of(scene).channels->grid(), scene.size);
  return scene;
}

/// Kinds of scenes, on grids whose cells are all alike and on others.
class MultivariateFrames : public testing::TestWithParam<std::tuple<Kind, bool>> {};

/// Every instruction set gives every pixel within the tolerance, and within what the two say that
/// they are off by of the rays that go one by one.
TEST_P(MultivariateFrames, AreTheSameInEveryInstructionSet) {
  const auto& [kind, rectilinear] = GetParam();
  Scene scene = make_scene(kind, rectilinear);
  for (const Grade grade : {Grade::estimated, Grade::proved}) {
    for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
      if (tolerance < 1e-5 && kind.primitives > 3) continue;  // minutes
      scene.integration.grade = grade;
      scene.integration.tolerance = tolerance;
      RenderOptions options;
      options.outputs.error = true;
      options.machine.instruction_set = InstructionSet::scalar;
      const Image alone = render(scene, options).image;
      for (const InstructionSet set : packet_sets) {
        if (!test::runs_here(set)) continue;
        options.machine.instruction_set = set;
        const auto [lanes, report] = render(scene, options);
        EXPECT_EQ(report.pixels_over_tolerance, 0u);
        double opaque = 0;
        for (std::size_t i = 0; i < lanes.pixels.size(); ++i) {
          const double allowed = double{lanes.error[i]} + double{alone.error[i]};
          for (std::size_t c = 0; c < 4; ++c) {
            ASSERT_LE(std::fabs(double{lanes.pixels[i][c]} - double{alone.pixels[i][c]}), allowed)
                << name_of(set) << ", pixel " << i << ", tolerance " << tolerance;
          }
          opaque = std::max(opaque, double{lanes.pixels[i][3]});
        }
        EXPECT_GT(opaque, 0.01);
        EXPECT_GT(report.spans.lines + report.spans.panels + report.spans.strides, 0u);
      }
    }
  }
}

/// Data of 1e6 in double, and a color that changes from end to end within 2e-8 of it: rounding of
/// the data is all that there is to be off by, and it is said.
TEST(MultivariateFrame, ColorOfATableIsChargedWithTheRoundingOfTheData) {
  Volume::Description description;
  description.dimensions = {5, 5, 5};
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<double> values;
  for (int i = 0; i < 125; ++i) values.push_back(1e6 + 2e-8 * unit(random));
  const auto volume = std::make_shared<Volume>(description, VolumeData(DataArray<double>(values)));
  Scene scene;
  test::channels_of(scene).channels =
      std::make_shared<Channels>(std::vector<Channel>{{"value", "", volume}});
  std::vector<ChannelTransferFunction> tables{
      {0, TransferFunction({{1e6 - 1e-8, 0.4, {0, 0, 0}}, {1e6 + 1e-8, 0.4, {1, 1, 1}}})}};
  test::channels_of(scene).transfer_function = std::make_shared<MultivariateTransferFunction>(
      1, std::vector<GaussianPrimitive>{}, std::move(tables));
  scene.size = {12, 12};
  scene.camera = default_camera(*volume, scene.size);
  scene.integration.tolerance = 1e-4;
  scene.integration.grade = Grade::proved;
  RenderOptions options;
  options.outputs.error = true;
  const Image reference = render_reference(scene).image;
  for (const InstructionSet set : instruction_sets) {
    if (!test::runs_here(set)) continue;
    options.machine.instruction_set = set;
    const Image image = render(scene, options).image;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      for (std::size_t c = 0; c < 4; ++c) {
        EXPECT_LE(std::fabs(double{image.pixels[i][c]} - double{reference.pixels[i][c]}),
                  double{image.error[i]})
            << name_of(set) << ", pixel " << i;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, MultivariateFrames,
    testing::Combine(
        testing::Values(Kind{.name = "wide", .width = 0.5, .extinction = 0.1},
                        Kind{.name = "narrow", .width = 0.003, .extinction = 20},
                        Kind{.name = "noise", .points = 9, .width = 0.02, .noise = 0.3},
                        Kind{.name = "one_cell", .points = 2, .width = 0.2, .noise = 0.3},
                        Kind{.name = "vacuum", .channels = 2, .width = 0.1, .vacuum = true},
                        Kind{.name = "opaque", .width = 0.05, .extinction = 1e4},
                        Kind{.name = "many", .primitives = 130, .width = 0.01, .extinction = 0.3},
                        Kind{.name = "table", .width = 0.02, .table = true},
                        Kind{.name = "channels", .channels = 5, .width = 0.3}),
        testing::Bool()),
    [](const auto& scene) {
      return std::get<Kind>(scene.param).name + (std::get<bool>(scene.param) ? "_rectilinear" : "");
    });

}  // namespace
}  // namespace pellucid
