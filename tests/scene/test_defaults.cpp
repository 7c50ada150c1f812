// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "pellucid/scene/builtin_fields.h"
#include "pellucid/scene/defaults.h"

namespace pellucid::test_defaults {
namespace {

constexpr int side = 24;

template <class Value>
Volume make_volume(const std::vector<Value>& values, double spacing = 1) {
  Volume::Description description;
  description.dimensions = {side, side, side};
  description.placement.spacing = {spacing, spacing, spacing};
  return Volume(description, VolumeData(values));
}

/// Noisy air, and a cube of soft tissue with a core of bone: 1/8 and 1/216 of the box.
std::vector<float> head(float air = 0, float tissue = 100, float bone = 1000, float noise = 5) {
  std::vector<float> values;
  unsigned random = 1;
  for (int k = 0; k < side; ++k) {
    for (int j = 0; j < side; ++j) {
      for (int i = 0; i < side; ++i) {
        const int d = std::max(
            {std::abs(2 * i - side + 1), std::abs(2 * j - side + 1), std::abs(2 * k - side + 1)});
        random = random * 1664525U + 1013904223U;
        const float n = noise * (static_cast<float>(random >> 8) / 8388608.0F - 1);
        values.push_back((d < side / 6 ? bone : d < side / 2 ? tissue : air) + n);
      }
    }
  }
  return values;
}

double extinction_at(const TransferFunction& transfer_function, double value) {
  return transfer_function.view<double>().evaluate(value).extinction;
}

/// What holds for every volume with more than one value.
void expect_usable(const TransferFunction& transfer_function) {
  const auto& points = transfer_function.points();
  ASSERT_GE(points.size(), 2U);
  EXPECT_LE(points.size(), 8U);
  EXPECT_EQ(points.front().extinction, 0);
  EXPECT_GT(points.back().extinction, 0);
  for (std::size_t i = 1; i < points.size(); ++i) {
    EXPECT_GT(points[i].value, points[i - 1].value);
    EXPECT_GE(points[i].extinction, points[i - 1].extinction);
  }
}

TEST(DefaultTransferFunction, SeesThroughAirAndThroughTissueToTheBone) {
  const TransferFunction f = default_transfer_function(make_volume(head()));
  expect_usable(f);
  EXPECT_EQ(extinction_at(f, 5), 0);
  // Air does not dim, tissue (12 wide) lets through at least a fifth, bone (4 wide)
  // less than that.
  const double through_tissue = 12 * extinction_at(f, 100),
               through_bone = 4 * extinction_at(f, 1000);
  EXPECT_GT(through_tissue, 0.3);
  EXPECT_LT(through_tissue, 1.5);
  EXPECT_GT(through_bone, 1.6);
  EXPECT_LT(through_bone, 8);
}

TEST(DefaultTransferFunction, FindsAirInHounsfieldUnits) {
  const TransferFunction f = default_transfer_function(make_volume(head(-1000, 40, 1200, 30)));
  expect_usable(f);
  EXPECT_EQ(extinction_at(f, -970), 0);
  EXPECT_GT(extinction_at(f, 40), 0);
  EXPECT_GT(extinction_at(f, 1200), 2 * extinction_at(f, 40));
}

TEST(DefaultTransferFunction, LooksTheSameAtEverySize) {
  const TransferFunction small = default_transfer_function(make_volume(head(), 0.5));
  const TransferFunction large = default_transfer_function(make_volume(head(), 50));
  ASSERT_EQ(small.points().size(), large.points().size());
  for (std::size_t i = 0; i < small.points().size(); ++i) {
    EXPECT_EQ(small.points()[i].value, large.points()[i].value);
    EXPECT_NEAR(small.points()[i].extinction, 100 * large.points()[i].extinction,
                1e-9 * small.points()[i].extinction);
  }
}

TEST(DefaultTransferFunction, HasNumbersThatOneCanType) {
  for (const auto& values : {head(), head(-1000, 40, 1200, 30), head(0.001F, 0.02F, 0.3F, 1e-4F)}) {
    const TransferFunction f = default_transfer_function(make_volume(values));
    for (const auto& point : f.points()) {
      char text[32];
      std::snprintf(text, sizeof text, "%.5g", point.value);
      EXPECT_EQ(std::strtod(text, nullptr), point.value) << text;
      std::snprintf(text, sizeof text, "%.2g", point.extinction);
      EXPECT_EQ(std::strtod(text, nullptr), point.extinction) << text;
    }
  }
}

TEST(DefaultTransferFunction, IsNotLedAstrayByAFewWildValues) {
  std::vector<float> values = head();
  values[7] = 1e30F;
  values[77] = -1e30F;
  const TransferFunction f = default_transfer_function(make_volume(values));
  expect_usable(f);
  EXPECT_GT(extinction_at(f, 100), 0);
  EXPECT_EQ(extinction_at(f, 5), 0);
}

TEST(DefaultTransferFunction, KeepsWhatIsRare) {
  // One value in 13824 is not zero: less than the share of wild values that is drawn in.
  std::vector<std::uint8_t> values(side * side * side, 0);
  values[5000] = 1;
  const TransferFunction f = default_transfer_function(make_volume(values));
  expect_usable(f);
  EXPECT_EQ(extinction_at(f, 0), 0);
  EXPECT_GT(extinction_at(f, 1), 0);
}

TEST(DefaultTransferFunction, ShowsAMask) {
  std::vector<std::uint16_t> values(side * side * side, 0);
  for (std::size_t i = 0; i < values.size(); i += 3) values[i] = 1;
  const TransferFunction f = default_transfer_function(make_volume(values));
  expect_usable(f);
  EXPECT_EQ(extinction_at(f, 0), 0);
  EXPECT_GT(extinction_at(f, 1), 0);
}

TEST(DefaultTransferFunction, ShowsAConstantAsHaze) {
  const TransferFunction f = default_transfer_function(
      make_volume(std::vector<float>(static_cast<std::size_t>(side) * side * side, 3.5F)));
  ASSERT_EQ(f.points().size(), 1U);
  EXPECT_EQ(f.points()[0].value, 3.5);
  // The mean chord of a cube is 2/3 of its edge.
  EXPECT_NEAR(f.points()[0].extinction * (side - 1) * 2 / 3, 1, 0.05);
}

TEST(DefaultTransferFunction, TakesEveryValidVolume) {
  const auto count = static_cast<std::size_t>(side) * side * side;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double largest = 1e37;  // near the most that a Volume takes
  EXPECT_NO_THROW(default_transfer_function(make_volume(std::vector<double>(count, nan))));
  std::vector<double> values(count, nan);
  values[3] = 2;
  EXPECT_NO_THROW(default_transfer_function(make_volume(values)));
  values[4] = 5;
  expect_usable(default_transfer_function(make_volume(values)));

  for (const auto& [low, high] : std::vector<std::pair<double, double>>{{-largest, largest},
                                                                        {0, largest},
                                                                        {0, 5e-324},
                                                                        {-5e-324, 5e-324},
                                                                        {1e-310, 1e-300},
                                                                        {1e9, 1e9 + 1e-6},
                                                                        {1, std::nextafter(1, 2)},
                                                                        {-1e30, 1e30},
                                                                        {-3, -1}}) {
    for (const std::size_t period : {2U, 3U, 5000U}) {
      for (std::size_t i = 0; i < count; ++i) values[i] = i % period == 0 ? high : low;
      for (const double spacing : {1e-30, 1.0, 1e30}) {
        SCOPED_TRACE(std::to_string(low) + " " + std::to_string(high) + " " +
                     std::to_string(period) + " " + std::to_string(spacing));
        EXPECT_NO_THROW(default_transfer_function(make_volume(values, spacing)));
      }
    }
  }
}

// Up to the largest numbers that a volume holds.
TEST(DefaultTransferFunction, ScalesWithTheData) {
  const std::vector<float> values = head();
  const auto plain = default_transfer_function(make_volume(values)).points();
  for (const auto& [scale, offset] : std::vector<std::pair<double, double>>{
           {1e30, 0}, {1e34, 0}, {2e34, 0}, {1e-30, 0}, {1e-37, 0}, {1e3, 1e6}, {1, -1e6}}) {
    SCOPED_TRACE(std::to_string(scale) + ", " + std::to_string(offset));
    std::vector<double> scaled;
    for (const float value : values) {
      scaled.push_back(scale * static_cast<double>(value) + offset);
    }
    const auto points = default_transfer_function(make_volume(scaled)).points();
    ASSERT_EQ(points.size(), plain.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      // What is rounded to a readable number is off by a thousandth of the range, 1010.
      EXPECT_NEAR((points[i].value - offset) / scale, plain[i].value, 5.1) << i;
      EXPECT_EQ(points[i].extinction, plain[i].extinction) << i;
      EXPECT_EQ(points[i].color, plain[i].color) << i;
    }
  }
  for (const double spacing : {1e-6, 1e6, 1e-25, 1e25}) {
    const auto points = default_transfer_function(make_volume(values, spacing)).points();
    ASSERT_EQ(points.size(), plain.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_EQ(points[i].value, plain[i].value);
      EXPECT_NEAR(points[i].extinction * spacing, plain[i].extinction, 0.06 * plain[i].extinction);
    }
  }
}

TEST(DefaultTransferFunction, IsUsableForEveryBuiltinField) {
  for (const std::string_view name : builtin_field_names()) {
    SCOPED_TRACE(name);
    const TransferFunction f = default_transfer_function(make_builtin_field(name, 33));
    if (name != "constant") expect_usable(f);
  }
}

TEST(DefaultCamera, SeesTheWholeBoxWithTheMarginThatIsStated) {
  Volume::Description slab;
  slab.dimensions = {40, 30, 3};
  slab.placement.origin = {100, -50, 7};
  slab.placement.spacing = {0.5, 2, 3};
  const std::vector<Volume> volumes = [&] {
    std::vector<Volume> list;
    list.push_back(make_volume(head()));
    list.emplace_back(slab, VolumeData(std::vector<float>(40 * 30 * 3, 1)));
    return list;
  }();
  for (const Volume& volume : volumes) {
    for (const ImageSize size : {ImageSize{512, 512}, ImageSize{640, 200}, ImageSize{100, 333}}) {
      const Camera camera = default_camera(volume, size);
      const CameraFrame<double> frame = make_camera_frame(camera, size);
      double outermost = 0;
      for (const Vec3<double>& corner : volume.world_corners()) {
        const Vec3<double> v = corner - camera.position;
        const double depth = dot(v, frame.forward);
        ASSERT_GT(depth, 0);
        // Where the corner is in the picture, in ±1 in both directions.
        outermost = std::max(
            {outermost, std::abs(dot(v, frame.right)) / (depth * dot(frame.right, frame.right)),
             std::abs(dot(v, frame.up)) / (depth * dot(frame.up, frame.up))});
      }
      EXPECT_NEAR(outermost, 1 / 1.05, 1e-12) << size.width << " x " << size.height;
    }
  }
}

TEST(DefaultCamera, LooksFromTheFrontTheLeftAndAbove) {
  const Volume volume = make_volume(head());
  const Camera camera = default_camera(volume, {512, 512});
  const Vec3<double> from = normalized(camera.position - camera.focal_point);
  constexpr double degree = std::numbers::pi / 180;
  EXPECT_NEAR(from.x, 0.5 * std::cos(20 * degree), 1e-12);
  EXPECT_NEAR(from.y, -std::cos(30 * degree) * std::cos(20 * degree), 1e-12);
  EXPECT_NEAR(from.z, std::sin(20 * degree), 1e-12);
  EXPECT_EQ(camera.up, (Vec3<double>{0, 0, 1}));
  EXPECT_EQ(camera.focal_point, (Vec3<double>{11.5, 11.5, 11.5}));
}

}  // namespace
}  // namespace pellucid::test_defaults
