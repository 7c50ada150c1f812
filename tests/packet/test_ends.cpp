// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "pellucid/cpu/render.h"
#include "pellucid/scene/defaults.h"
#include "tests/support/instruction_sets.h"
#include "tests/support/one_layer.h"

namespace pellucid {
namespace {

using Points = std::vector<TransferFunction::Point>;

constexpr int width = 12;
template <class Value>
std::shared_ptr<Volume> make_volume(const std::function<double(int, int, int)>& value,
                                    double spacing = 1) {
  std::vector<Value> data;
  for (int z = 0; z < width; ++z) {
    for (int y = 0; y < width; ++y) {
      for (int x = 0; x < width; ++x) data.push_back(static_cast<Value>(value(x, y, z)));
    }
  }
  Volume::Description description;
  description.dimensions = {width, width, width};
  description.placement.spacing = {spacing, spacing, spacing};
  description.name = "ends";
  return std::make_shared<Volume>(description, DataArray<Value>(std::move(data)));
}

/// Teeth with a corner at each of the values.
Points teeth(const std::vector<double>& values, double extinction) {
  Points points;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double s = i % 2 == 0 ? 0 : 1;
    points.push_back({values[i], s * extinction, {s, 0.5, 1 - 0.5 * s}});
  }
  return points;
}

/// A frame of each instruction set, at some tolerances, along an axis and aslant, is made at all,
/// and has nothing that is no number. What would not end is stopped by the time limit of the test.
void renders(std::shared_ptr<Volume> volume, Points points, int* scalar_fallback = nullptr) {
  Scene scene;
  test::volume_of(scene).volume = std::move(volume);
  test::volume_of(scene).transfer_function = std::make_shared<TransferFunction>(std::move(points));
  scene.size = {32, 32};
  RenderOptions options;
  options.machine.threads = 1;
  options.outputs.error = true;
  const Camera aslant = default_camera(*test::volume_of(scene).volume, scene.size);
  Camera along = aslant;
  const double far = length(aslant.position - aslant.focal_point);
  along.position = along.focal_point + Vec3<double>{0, 0, far};
  along.up = {0, 1, 0};
  along.projection = Projection::orthographic;
  along.parallel_scale = test::volume_of(scene).volume->voxel_size() * width / 2;
  for (const InstructionSet set : packet_sets) {
    if (!test::runs_here(set)) continue;
    options.machine.instruction_set = set;
    for (const double tolerance : {1.0, default_tolerance, 2e-5}) {
      scene.integration.tolerance = tolerance;
      for (const Camera& camera : {aslant, along}) {
        scene.camera = camera;
        const auto [image, report] = render(scene, options);
        if (scalar_fallback != nullptr)
          *scalar_fallback += static_cast<int>(report.spans.in_double);
        for (std::size_t i = 0; i < image.pixels.size(); ++i) {
          ASSERT_LE(static_cast<double>(image.error[i]), tolerance * (1 + 1e-6));
          for (const float c : image.pixels[i]) ASSERT_TRUE(std::isfinite(c));
        }
      }
    }
  }
}

class PacketEnds : public testing::Test {
 protected:
  void SetUp() override {
    if (std::none_of(std::begin(packet_sets), std::end(packet_sets), test::runs_here)) {
      GTEST_SKIP() << "this machine has no instruction set for packets";
    }
  }
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }

  std::mt19937 random_{11};
};

TEST_F(PacketEnds, BytesWithAControlPointAtEachOfThem) {
  const auto noise = make_volume<std::uint8_t>([&](int, int, int) { return below(32); });
  std::vector<double> values;
  for (int v = 0; v < 32; ++v) values.push_back(v);
  renders(noise, teeth(values, 0.3));
  renders(noise, teeth(values, 300));
}

TEST_F(PacketEnds, PlateausAtControlPoints) {
  const double levels[] = {0.25, 0.5, 0.75};
  const auto blocks =
      make_volume<float>([&](int x, int y, int z) { return levels[(x / 3 + y / 3 + z / 3) % 3]; });
  renders(blocks, teeth({0.25, 0.5, 0.75}, 2));
  renders(blocks, teeth({0.1, 0.25, 0.4, 0.5, 0.6, 0.75}, 2));
  // The same everywhere: on a corner, and on a jump.
  const auto flat = make_volume<float>([](int, int, int) { return 0.5; });
  renders(flat, teeth({0.25, 0.5, 0.75}, 2));
  renders(flat, {{0.5, 0.1, {1, 1, 1}}, {0.5, 1, {1, 0, 0}}});
}

TEST_F(PacketEnds, ValuesAnUlpFromControlPoints) {
  for (const float at : {1.0f, 0.1f, 1e6f, -3.0f}) {
    SCOPED_TRACE(at);
    const auto close = make_volume<float>([&](int, int, int) {
      float v = at;
      for (int n = below(4); n > 0; --n) v = std::nextafter(v, 1e38f);
      return static_cast<double>(v);
    });
    std::vector<double> values;
    float v = at;
    for (int k = 0; k < 4; ++k, v = std::nextafter(v, 1e38f)) {
      values.push_back(static_cast<double>(v));
    }
    renders(close, teeth(values, 1));
    const double x = static_cast<double>(at);
    renders(close, teeth({x - 1, x, x + 1}, 1));
    renders(close, {{x, 0.2, {1, 1, 0}}, {x, 1, {1, 0, 0}}});
  }
}

TEST_F(PacketEnds, TurnsAtControlPoints) {
  // Of a bilinear saddle, squares and cubes along diagonals: turns and inflections on the corners.
  const auto saddle = make_volume<float>(
      [](int x, int y, int z) { return (x - 6.0) * (y - 6.0) / 36 + 0.01 * (z - 6); });
  renders(saddle, teeth({-0.5, -0.25, 0, 0.25, 0.5}, 1));
  const auto signs =
      make_volume<std::int8_t>([](int x, int y, int z) { return (x + y + z) % 2 == 0 ? 1 : -1; });
  renders(signs, teeth({-1, 0, 1}, 1));
  renders(signs, {{-1, 1, {1, 0, 0}}, {0, 0, {0, 1, 0}}, {0, 2, {0, 1, 1}}, {1, 0, {0, 0, 1}}});
}

TEST_F(PacketEnds, JumpsAreHandedBack) {
  int scalar_fallback = 0;
  const auto noise = make_volume<std::int16_t>([&](int, int, int) { return below(2000) - 1000; });
  Points points;
  for (int v = -900; v <= 900; v += 300) {
    points.push_back({1.0 * v, 0.1, {1, 0, 0}});
    points.push_back({1.0 * v, 0.5, {0, 1, 0}});
  }
  renders(noise, points, &scalar_fallback);
  EXPECT_GT(scalar_fallback, 1000);
}

TEST_F(PacketEnds, SizesAtTheLimits) {
  const auto noise = [&](int, int, int) { return below(100) * 0.01; };
  for (const double spacing : {1e-9, 1e-3, 1e3, 1e9}) {
    SCOPED_TRACE(spacing);
    renders(make_volume<float>(noise, spacing), teeth({0.1, 0.3, 0.5, 0.7}, 1 / spacing));
  }
  for (const double scale : {1e-10, 1e10}) {
    SCOPED_TRACE(scale);
    const auto scaled =
        make_volume<double>([&](int, int, int) { return scale * below(100) * 0.01; });
    renders(scaled, teeth({0.1 * scale, 0.3 * scale, 0.5 * scale, 0.7 * scale}, 1));
  }
}

}  // namespace
}  // namespace pellucid
