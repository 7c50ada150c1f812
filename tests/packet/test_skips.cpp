// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "pellucid/cpu/render.h"
#include "pellucid/scene/defaults.h"
#include "tests/packet/random_frames.h"
#include "tests/support/instruction_sets.h"
#include "tests/support/one_layer.h"

namespace pellucid {
namespace {

/// Random smooth fields and narrow peaks on their values: what packets pass over because the data
/// cannot get that far would be missing from the pixel, and is in the double-precision frame, which
/// goes from cell to cell.
class PacketSkips : public testing::TestWithParam<unsigned> {
 protected:
  double uniform(double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random_);
  }
  bool one_in(int n) { return std::uniform_int_distribution<int>(1, n)(random_) == 1; }

  double wave(double x, double y, double z) const {
    double sum = 0;
    for (const auto& w : waves_) sum += std::sin(w[0] * x + w[1] * y + w[2] * z + 6 * w[3]);
    return sum / 6;
  }

  Scene make_scene() {
    for (auto& w : waves_) {
      for (double& x : w) x = uniform(-1, 1) * std::pow(10, uniform(-2, 0));
    }
    const bool folded = one_in(4), spikes = one_in(4), vacuum = one_in(5);
    const double offset = one_in(4) ? uniform(-100, 100) : 0;
    const double scale = one_in(4) ? std::pow(10, uniform(-4, 4)) : 1;
    Volume::Description description;
    description.centering = one_in(3) ? Centering::cell : Centering::point;
    for (int a = 0; a < 3; ++a) {
      description.dimensions[static_cast<std::size_t>(a)] = static_cast<int>(uniform(9, 40));
      description.placement.spacing[a] = one_in(2) ? 1 : uniform(0.3, 2);
    }
    std::vector<float> data;
    for (int z = 0; z < description.dimensions[2]; ++z) {
      for (int y = 0; y < description.dimensions[1]; ++y) {
        for (int x = 0; x < description.dimensions[0]; ++x) {
          double v = wave(x, y, z);
          if (folded) v = std::fabs(v);
          if (spikes && one_in(3000)) v += 0.3;
          data.push_back(static_cast<float>(scale * (offset + 0.5 + v)));
        }
      }
    }
    const double middle = static_cast<double>(data[data.size() / 3]);
    if (vacuum) {
      for (const std::size_t i : {data.size() / 2, data.size() / 5}) {
        data[i] = std::numeric_limits<float>::quiet_NaN();
      }
    }
    const double half_width = scale * std::pow(10, uniform(-3, -0.7));
    const double extinction = std::pow(10, uniform(-1, 2));
    std::vector<TransferFunction::Point> points;
    for (int k = 0; k < (one_in(3) ? 3 : 1); ++k) {
      const double at = middle + 4 * k * half_width;
      points.push_back({at - half_width, 0, {1, 0, 0}});
      points.push_back({at, extinction, {0, 1, 0.5}});
      points.push_back({at + half_width, 0, {0, 0, 1}});
    }
    Scene scene;
    description.name = "waves";
    test::volume_of(scene).volume =
        std::make_shared<Volume>(description, DataArray<float>(std::move(data)));
    test::volume_of(scene).transfer_function =
        std::make_shared<TransferFunction>(std::move(points));
    scene.size = {20, 20};
    scene.camera = default_camera(*test::volume_of(scene).volume, scene.size);
    if (one_in(2)) {
      scene.camera.projection = Projection::orthographic;
      scene.camera.parallel_scale =
          length(scene.camera.position - scene.camera.focal_point) / uniform(2, 6);
    }
    scene.integration.tolerance = one_in(2) ? 1.0 / 512 : 1e-3;
    return scene;
  }

 private:
  std::mt19937 random_{GetParam()};
  double waves_[3][4] = {};
};

TEST_P(PacketSkips, LoseNothing) {
  for (int round = 0; round < 12; ++round) {
    const Scene scene = make_scene();
    RenderOptions options;
    options.machine.threads = 1;
    options.outputs.error = true;
    Scene precise = scene;
    precise.integration.tolerance = 1e-6;
    precise.integration.precision = Precision::float64;
    const Image expected = render(precise, options).image;
    for (const InstructionSet set : packet_sets) {
      if (!test::runs_here(set)) continue;
      options.machine.instruction_set = set;
      const Image found = render(scene, options).image;
      for (std::size_t i = 0; i < found.pixels.size(); ++i) {
        for (std::size_t c = 0; c < 4; ++c) {
          const double off = std::fabs(static_cast<double>(found.pixels[i][c]) -
                                       static_cast<double>(expected.pixels[i][c]));
          ASSERT_LE(off, static_cast<double>(found.error[i]) +
                             static_cast<double>(expected.error[i]) + 3e-7)
              << "round " << round << ", pixel " << i << ", " << name_of(set);
        }
      }
    }
  }
}

/// Cubes of blocks to skip reach beyond the grid.
TEST(PacketSkip, KeepsRaysInTheFaces) {
  for (const int points : {17, 20, 21, 25, 33}) {
    Scene scene = ramp_seen_in_faces(points, 18);
    const auto data = test::channels_of(scene).channels->begin()->volume;
    test::volume_of(scene).volume = data;
    test::volume_of(scene).transfer_function =
        std::make_shared<const TransferFunction>(std::vector<TransferFunction::Point>{
            {0.1, 0, {1, 1, 1}}, {0.2, 0.5, {1, 1, 1}}, {0.3, 0, {1, 1, 1}}});
    // 30 cells by unit, a triangle of width 0.2.
    const double opacity = 1 - std::exp(-30 * 0.5 * 0.1);
    RenderOptions options;
    for (const InstructionSet set : packet_sets) {
      if (!test::runs_here(set)) continue;
      options.machine.instruction_set = set;
      for (const auto& pixel : render(scene, options).image.pixels) {
        EXPECT_NEAR(pixel[3], opacity, 3e-3) << name_of(set) << ", " << points;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, PacketSkips, testing::Range(1u, 9u));

/// A ramp that bends, behind narrow peaks at these values.
Scene ramp_behind(const std::vector<double>& peaks) {
  Volume::Description description;
  description.dimensions = {64, 64, 64};
  description.name = "ramp";
  std::vector<float> data;
  for (int z = 0; z < 64; ++z) {
    for (int y = 0; y < 64; ++y) {
      for (int x = 0; x < 64; ++x) data.push_back(static_cast<float>(0.01 * x + 0.002 * y * y));
    }
  }
  Scene scene;
  test::volume_of(scene).volume =
      std::make_shared<Volume>(description, DataArray<float>(std::move(data)));
  std::vector<TransferFunction::Point> points;
  for (const double peak : peaks) {
    points.push_back({peak, 0, {1, 1, 1}});
    points.push_back({peak + 0.01, 5, {1, 1, 1}});
    points.push_back({peak + 0.02, 0, {1, 1, 1}});
  }
  test::volume_of(scene).transfer_function = std::make_shared<TransferFunction>(std::move(points));
  scene.size = {32, 32};
  scene.camera = default_camera(*test::volume_of(scene).volume, scene.size);
  return scene;
}

/// Where the data keep away from what absorbs, most cells are not looked at: around one peak that
/// is in the range of every block of one layer, and between several.
TEST(PacketSkipsCost, SmoothDataAreCrossedInFewSteps) {
  for (const std::vector<double>& peaks :
       {std::vector<double>{2.0}, std::vector<double>{1.0, 1.4, 2.0, 2.7}}) {
    const Scene scene = ramp_behind(peaks);
    RenderOptions options;
    options.machine.threads = 1;
    RenderReport one_by_one, packets;
    options.machine.instruction_set = InstructionSet::scalar;
    one_by_one = render(scene, options).report;
    for (const InstructionSet set : packet_sets) {
      if (!test::runs_here(set)) continue;
      options.machine.instruction_set = set;
      packets = render(scene, options).report;
      EXPECT_GT(packets.cells, 0u);
      EXPECT_LT(packets.cells, one_by_one.cells / 2) << name_of(set) << ", " << peaks.size();
    }
  }
}

}  // namespace
}  // namespace pellucid
