// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/volume.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "expect_error.h"

namespace pellucid::test_volume {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Volume::Description description(int nx, int ny, int nz) {
  Volume::Description d;
  d.dimensions = {nx, ny, nz};
  d.name = "knee.nrrd";
  return d;
}

VolumeData zeros(std::size_t count) {
  return std::vector<float>(count);
}

void expect_refused(const Volume::Description& d, VolumeData data,
                    std::initializer_list<const char*> parts) {
  expect_error([&] { const Volume volume(d, std::move(data)); }, parts);
}

void expect_near(const Vec3<double>& p, const Vec3<double>& q, double tolerance = 1e-12) {
  EXPECT_NEAR(p.x, q.x, tolerance);
  EXPECT_NEAR(p.y, q.y, tolerance);
  EXPECT_NEAR(p.z, q.z, tolerance);
}

TEST(VolumeData, TypesByName) {
  for (const char* name : {"u8", "i8", "u16", "i16", "u32", "i32", "f32", "f64"}) {
    const VolumeData data = make_volume_data(name, 5);
    EXPECT_EQ(type_name(data), name);
    std::visit([](const auto& values) { EXPECT_EQ(values.size(), 5u); }, data);
  }
  EXPECT_TRUE(std::holds_alternative<DataArray<std::int16_t>>(make_volume_data("i16", 1)));
  expect_error([] { make_volume_data("u64", 1); }, {"\"u64\"", "unknown", "f32"});
}

TEST(VolumeErrors, SizesThatDoNotAgree) {
  expect_refused(description(2, 3, 4), zeros(23), {"knee.nrrd: ", "2 x 3 x 4", "24", "23"});
  expect_refused(description(0, 3, 4), zeros(0), {"0 x 3 x 4", "from 1"});
  expect_refused(description(2, -3, 4), zeros(24), {"2 x -3 x 4", "from 1"});
  const int huge = std::numeric_limits<int>::max();
  expect_refused(description(huge, 2, 2), zeros(1), {"from 1 to 2147483645"});
  expect_refused(description(huge - 2, huge - 2, huge - 2), zeros(1), {"can be addressed"});
  // 2^21 · 2^21 · 2^22 = 2^64 would wrap around to 0 values.
  expect_refused(description(1 << 21, 1 << 21, 1 << 22), zeros(0), {"can be addressed"});
}

TEST(VolumeErrors, SinglePointSaysWhatToDo) {
  expect_refused(description(4, 1, 4), zeros(16), {"single value along y", "cell centering"});
  Volume::Description d = description(4, 1, 4);
  d.centering = Centering::cell;
  EXPECT_NO_THROW(Volume(d, zeros(16)));
}

TEST(VolumeErrors, Placement) {
  for (const double bad : {0.0, -1.0, nan, infinity}) {
    Volume::Description d = description(2, 2, 2);
    d.placement.spacing.z = bad;
    expect_refused(d, zeros(8), {"spacing along z", "positive"});
  }
  Volume::Description d = description(2, 2, 2);
  d.placement.origin.y = nan;
  expect_refused(d, zeros(8), {"origin is (0, nan, 0)", "finite"});

  d = description(2, 2, 2);
  d.placement.direction.column[1].x = infinity;
  expect_refused(d, zeros(8), {"direction", "column 1"});

  d = description(2, 2, 2);
  d.placement.direction.column[1] = {2, 0, 0};
  expect_refused(d, zeros(8), {"direction is singular", "(2, 0, 0)", "independent"});

  d = description(2, 2, 2);
  d.placement.direction.column[2] = {0, 0, 0};
  expect_refused(d, zeros(8), {"direction is singular"});

  // Parallel but for what rounding leaves of a rotation.
  d = description(2, 2, 2);
  d.placement.direction.column[0] = {std::cos(0.1), std::sin(0.1), 0};
  d.placement.direction.column[1] = {3 * std::cos(0.1), 3 * std::sin(0.1) + 1e-15, 0};
  expect_refused(d, zeros(8), {"direction is singular"});

  d = description(2, 2, 2);
  d.placement.spacing = {1e308, 1, 1};
  d.dimensions = {20, 2, 2};
  expect_refused(d, zeros(80), {"beyond the range of double", "unit"});
}

TEST(Volume, SmallAndLargeUnitsAreNotSingular) {
  for (const double unit : {1e-150, 1e-9, 1e9, 1e150}) {
    Volume::Description d = description(2, 2, 2);
    d.placement.spacing = {unit, 2 * unit, unit};
    const Volume volume(d, zeros(8));
    EXPECT_DOUBLE_EQ(volume.voxel_size(), unit);
    expect_near(volume.grid_from_world().point({unit, unit, unit}), {1, 0.5, 1});
  }
}

TEST(VolumeErrors, Coordinates) {
  Volume::Description d = description(3, 2, 2);
  d.coordinates[0] = {0, 1};
  expect_refused(d, zeros(12), {"coordinates along x", "there are 2", "need 3", "one for each"});
  d.coordinates[0] = {0, 1, 1};
  expect_refused(d, zeros(12), {"coordinates along x", "number 2", "is 1 after 1", "ascend"});
  d.coordinates[0] = {0, 2, 1};
  expect_refused(d, zeros(12), {"coordinates along x", "number 2", "is 1 after 2", "ascend"});
  d.coordinates[0] = {0, nan, 1};
  expect_refused(d, zeros(12), {"coordinates along x", "number 1", "nan", "finite"});
  d.coordinates[0] = {-infinity, 0, 1};
  expect_refused(d, zeros(12), {"coordinates along x", "number 0", "-inf", "finite"});

  d.centering = Centering::cell;
  d.coordinates[0] = {0, 1, 2};
  expect_refused(d, zeros(12), {"coordinates along x", "there are 3", "need 4", "faces"});
  d.coordinates[0] = {1, 1 + 0x1p-52, 2, 3};
  expect_refused(d, zeros(12), {"coordinates along x", "no double between"});
}

TEST(VolumeErrors, InfiniteValues) {
  std::vector<float> values(24);
  values[1 + 2 * (2 + 3 * 3)] = -std::numeric_limits<float>::infinity();
  expect_refused(description(2, 3, 4), values,
                 {"knee.nrrd: ", "1 infinite value,", "(1, 2, 3)", "NaN"});
  values[2] = std::numeric_limits<float>::infinity();
  expect_refused(description(2, 3, 4), values, {"2 infinite values", "(0, 1, 0)"});

  std::vector<double> doubles(24);
  doubles[23] = 1e38;
  expect_refused(description(2, 3, 4), doubles, {"(1, 2, 3)", "2.12676466", "rescale"});
  // Eight corners of the largest admitted value still have a finite sum in float.
  const float largest = std::numeric_limits<float>::max() / 16;
  const Volume volume(description(2, 2, 2), std::vector<float>(8, largest));
  EXPECT_TRUE(std::isfinite(8 * static_cast<float>(volume.statistics().maximum)));
}

TEST(VolumeErrors, NamelessVolume) {
  Volume::Description d = description(2, 2, 2);
  d.name.clear();
  expect_refused(d, zeros(7), {"volume: "});
}

TEST(Volume, Statistics) {
  const float n = std::numeric_limits<float>::quiet_NaN();
  const Volume volume(description(2, 2, 2), std::vector<float>{n, 3, -2, n, 5, 0, n, 5});
  EXPECT_EQ(volume.statistics().minimum, -2);
  EXPECT_EQ(volume.statistics().maximum, 5);
  EXPECT_EQ(volume.statistics().finite, 5u);
  EXPECT_EQ(volume.statistics().nan, 3u);
  EXPECT_EQ(volume.statistics().infinite, 0u);

  const Volume negative(description(2, 2, 2), std::vector<float>(8, -3));
  EXPECT_EQ(negative.statistics().minimum, -3);
  EXPECT_EQ(negative.statistics().maximum, -3);

  const Volume empty(description(2, 2, 2), std::vector<double>(8, nan));
  EXPECT_EQ(empty.statistics().minimum, 0);
  EXPECT_EQ(empty.statistics().maximum, 0);
  EXPECT_EQ(empty.statistics().finite, 0u);
  EXPECT_EQ(empty.statistics().nan, 8u);
}

template <class Value>
void expect_full_range() {
  constexpr Value lowest = std::numeric_limits<Value>::min();
  constexpr Value highest = std::numeric_limits<Value>::max();
  const std::vector<Value> values{0, highest, 0, 0, lowest, 0, 0, 0};
  const Volume volume(description(2, 2, 2), values);
  EXPECT_EQ(volume.statistics().minimum, static_cast<double>(lowest));
  EXPECT_EQ(volume.statistics().maximum, static_cast<double>(highest));
  EXPECT_EQ(volume.statistics().finite, 8u);
  volume.visit([&](const auto& grid) {
    EXPECT_TRUE((std::is_same_v<std::decay_t<decltype(*grid.data)>, Value>));
    EXPECT_EQ(grid.data[1], highest);
    EXPECT_EQ(grid.template corners<double>(0, 0, 0).value[4], static_cast<double>(lowest));
  });
}

TEST(Volume, IntegerTypesKeepTheirRange) {
  expect_full_range<std::uint8_t>();
  expect_full_range<std::int8_t>();
  expect_full_range<std::uint16_t>();
  expect_full_range<std::int16_t>();
  expect_full_range<std::uint32_t>();
  expect_full_range<std::int32_t>();
}

TEST(Volume, Histogram) {
  const float n = std::numeric_limits<float>::quiet_NaN();
  const Volume volume(description(2, 2, 2), std::vector<float>{n, 0, 1, 1.5F, 2, 3.5F, 4, 4});
  const Histogram h = volume.histogram(4);
  EXPECT_EQ(h.lower, 0);
  EXPECT_EQ(h.upper, 4);
  EXPECT_EQ(h.count, (std::vector<std::uint64_t>{1, 2, 1, 3}));
  EXPECT_EQ(volume.histogram(1).count, (std::vector<std::uint64_t>{7}));
  expect_error([&] { volume.histogram(0); }, {"bins is 0", "at least 1"});

  std::vector<std::uint8_t> bytes(256);
  for (std::size_t i = 0; i < 256; ++i) bytes[i] = static_cast<std::uint8_t>(i);
  const Histogram each = Volume(description(16, 4, 4), bytes).histogram(256);
  EXPECT_EQ(each.count, std::vector<std::uint64_t>(256, 1));
}

TEST(Volume, HistogramOfConstantAndEmpty) {
  const Volume constant(description(2, 2, 2), std::vector<float>(8, 7));
  EXPECT_EQ(constant.histogram(3).count, (std::vector<std::uint64_t>{0, 0, 8}));
  const Volume empty(description(2, 2, 2), std::vector<double>(8, nan));
  EXPECT_EQ(empty.histogram(3).count, (std::vector<std::uint64_t>{0, 0, 0}));
}

TEST(Volume, UniformPlacement) {
  Volume::Description d = description(3, 4, 5);
  d.placement.origin = {10, 20, 30};
  d.placement.spacing = {0.5, 2, 3};
  const Volume volume(d, zeros(60));
  expect_near(volume.grid_lower(), {0, 0, 0}, 0);
  expect_near(volume.grid_upper(), {2, 3, 4}, 0);
  expect_near(volume.world_from_grid().point({2, 3, 4}), {11, 26, 42});
  expect_near(volume.grid_from_world().point({11, 26, 42}), {2, 3, 4});
  EXPECT_DOUBLE_EQ(volume.voxel_size(), 0.5);
  const auto corners = volume.world_corners();
  expect_near(corners[0], {10, 20, 30});
  expect_near(corners[1], {11, 20, 30});
  expect_near(corners[2], {10, 26, 30});
  expect_near(corners[4], {10, 20, 42});
  expect_near(corners[7], {11, 26, 42});
}

TEST(Volume, CellCenteredBoxReachesHalfACellFurther) {
  Volume::Description d = description(3, 1, 5);
  d.centering = Centering::cell;
  d.placement.origin = {10, 20, 30};
  d.placement.spacing = {0.5, 2, 3};
  const Volume volume(d, zeros(15));
  expect_near(volume.grid_lower(), {-0.5, -0.5, -0.5}, 0);
  expect_near(volume.grid_upper(), {2.5, 0.5, 4.5}, 0);
  // A data value keeps its place: index 0 is at the origin.
  expect_near(volume.grid_from_world().point({10, 20, 30}), {0, 0, 0});
  expect_near(volume.world_corners()[0], {9.75, 19, 28.5});
  expect_near(volume.world_corners()[7], {11.25, 21, 43.5});
  EXPECT_DOUBLE_EQ(volume.voxel_size(), 0.5);
}

TEST(Volume, ShearedAndLeftHandedDirection) {
  Volume::Description d = description(3, 3, 3);
  d.placement.origin = {1, -2, 3};
  d.placement.spacing = {2, 3, 0.5};
  d.placement.direction.column[0] = {0, 1, 0};
  d.placement.direction.column[1] = {1, 0.5, 0};  // sheared, longer than 1
  d.placement.direction.column[2] = {0, 0.25, 1};
  ASSERT_LT(determinant(d.placement.direction), 0);
  const Volume volume(d, zeros(27));
  // By hand: origin + 1·2·(0,1,0) + 2·3·(1,½,0) + 1·½·(0,¼,1).
  const Vec3<double> world{7, 3.125, 3.5};
  expect_near(volume.world_from_grid().point({1, 2, 1}), world);
  expect_near(volume.grid_from_world().point(world), {1, 2, 1});
  EXPECT_DOUBLE_EQ(volume.voxel_size(), 0.5 * std::sqrt(1 + 0.0625));
  for (int n = 0; n < 8; ++n) {
    expect_near(volume.grid_from_world().point(volume.world_corners()[static_cast<std::size_t>(n)]),
                {n & 1 ? 2.0 : 0.0, n & 2 ? 2.0 : 0.0, n & 4 ? 2.0 : 0.0});
  }
}

TEST(Volume, RayParameterStaysTheWorldsArcLength) {
  Volume::Description d = description(3, 3, 3);
  d.placement.origin = {1, -2, 3};
  d.placement.spacing = {2, 3, 0.5};
  d.placement.direction.column[0] = {0.6, 0.8, 0};
  d.placement.direction.column[1] = {-0.8, 0.6, 0};
  const Volume volume(d, zeros(27));
  const Ray<double> world{{5, 6, 7}, normalized(Vec3<double>{-1, -2, -2})};
  const Ray<double> grid = volume.grid_from_world().ray(world);
  for (const double t : {0.0, 1.5, 9.0}) {
    expect_near(volume.world_from_grid().point(grid.at(t)), world.at(t));
  }
}

TEST(Volume, RectilinearPoints) {
  Volume::Description d = description(3, 2, 2);
  d.placement.origin = {100, 0, 0};
  d.placement.spacing = {-7, 1, 1};  // ignored along x
  d.coordinates[0] = {-1, 0.5, 8};
  const Volume volume(d, zeros(12));
  expect_near(volume.grid_lower(), {-1, 0, 0}, 0);
  expect_near(volume.grid_upper(), {8, 1, 1}, 0);
  expect_near(volume.world_from_grid().point({0.5, 0, 0}), {100.5, 0, 0});
  EXPECT_DOUBLE_EQ(volume.voxel_size(), 1);
  volume.visit([](const auto& grid) {
    EXPECT_EQ(grid.axis[0].cells(), 2);
    EXPECT_EQ(grid.axis[0].plane(1), 0.5);
    EXPECT_EQ(grid.axis[0].value_index(2), 2);
    EXPECT_EQ(grid.axis[1].plane_position, nullptr);
  });
}

TEST(Volume, RectilinearCells) {
  Volume::Description d = description(3, 2, 2);
  d.centering = Centering::cell;
  d.placement.direction.column[0] = {0, 3, 0};
  d.placement.direction.column[1] = {1, 0, 0};
  d.coordinates[0] = {0, 1, 1.25, 8};
  const Volume volume(d, zeros(12));
  // The shortest cell, not the shortest half cell.
  EXPECT_DOUBLE_EQ(volume.voxel_size(), 0.75);
  volume.visit([](const auto& grid) {
    ASSERT_EQ(grid.axis[0].cells(), 4);
    const double planes[] = {0, 0.5, 1.125, 4.625, 8};
    const int values[] = {0, 0, 1, 2, 2};
    for (int i = 0; i < 5; ++i) {
      EXPECT_EQ(grid.axis[0].plane(i), planes[i]);
      EXPECT_EQ(grid.axis[0].value_index(i), values[i]);
    }
  });
}

TEST(Volume, CopiesOwnTheirPlanes) {
  Volume::Description d = description(3, 2, 2);
  d.coordinates[0] = {-1, 0.5, 8};
  auto original = std::make_unique<Volume>(d, zeros(12));
  const Volume copy = *original;
  const Volume moved = std::move(*original);
  original.reset();
  for (const Volume* volume : {&copy, &moved}) {
    volume->visit([](const auto& grid) { EXPECT_EQ(grid.axis[0].plane(2), 8); });
  }
}

}  // namespace
}  // namespace pellucid::test_volume
