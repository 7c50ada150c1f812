// SPDX-License-Identifier: Apache-2.0
#include "pellucid/field/multichannel_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <tuple>
#include <type_traits>
#include <vector>

namespace pellucid::test_multichannel_grid {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A channel of every type on one grid, each with its own numbers.
struct EveryType {
  static constexpr int nx = 3, ny = 4, nz = 2;
  std::tuple<std::vector<std::uint8_t>, std::vector<std::int8_t>, std::vector<std::uint16_t>,
             std::vector<std::int16_t>, std::vector<std::uint32_t>, std::vector<std::int32_t>,
             std::vector<float>, std::vector<double>>
      data;
  MultichannelGrid grid;

  explicit EveryType(int padding) {
    std::mt19937 random(5);
    grid.channels = 8;
    const int values[3] = {nx, ny, nz};
    for (int a = 0; a < 3; ++a) grid.axis[a] = {nullptr, values[a], padding};
    int channel = 0;
    const auto fill = [&](auto& numbers, ValueType type) {
      using Value = typename std::decay_t<decltype(numbers)>::value_type;
      for (int i = 0; i < nx * ny * nz; ++i) {
        numbers.push_back(static_cast<Value>(static_cast<double>(random() % 120) -
                                             (std::is_signed_v<Value> ? 60 : 0)));
      }
      grid.data[channel] = numbers.data();
      grid.type[channel] = type;
      ++channel;
    };
    fill(std::get<0>(data), ValueType::u8);
    fill(std::get<1>(data), ValueType::i8);
    fill(std::get<2>(data), ValueType::u16);
    fill(std::get<3>(data), ValueType::i16);
    fill(std::get<4>(data), ValueType::u32);
    fill(std::get<5>(data), ValueType::i32);
    fill(std::get<6>(data), ValueType::f32);
    fill(std::get<7>(data), ValueType::f64);
  }
  template <std::size_t Channel>
  double at(int i, int j, int k) const {
    return static_cast<double>(
        std::get<Channel>(data)[static_cast<std::size_t>(i + nx * (j + ny * k))]);
  }
};

TEST(MultichannelGrid, EachChannelComesInItsOwnType) {
  const EveryType all(0);
  const auto is = [&](int channel, auto example) {
    return all.grid.visit_channel(channel, [&](const auto& grid) {
      EXPECT_EQ(grid.data, all.grid.data[channel]);
      EXPECT_EQ(grid.axis[1].values, EveryType::ny);
      return std::is_same_v<std::decay_t<decltype(*grid.data)>, decltype(example)>;
    });
  };
  EXPECT_TRUE(is(0, std::uint8_t{}));
  EXPECT_TRUE(is(1, std::int8_t{}));
  EXPECT_TRUE(is(2, std::uint16_t{}));
  EXPECT_TRUE(is(3, std::int16_t{}));
  EXPECT_TRUE(is(4, std::uint32_t{}));
  EXPECT_TRUE(is(5, std::int32_t{}));
  EXPECT_TRUE(is(6, float{}));
  EXPECT_TRUE(is(7, double{}));
}

/// At data values, and at the middle of cells: their mean.
TEST(MultichannelGrid, SamplesAreTrilinear) {
  const EveryType all(0);
  double v[max_channels];
  for (int k = 0; k < EveryType::nz; ++k) {
    for (int j = 0; j < EveryType::ny; ++j) {
      for (int i = 0; i < EveryType::nx; ++i) {
        ASSERT_TRUE(all.grid.sample<double>(
            {static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)}, v));
        EXPECT_EQ(v[0], all.at<0>(i, j, k));
        EXPECT_EQ(v[1], all.at<1>(i, j, k));
        EXPECT_EQ(v[2], all.at<2>(i, j, k));
        EXPECT_EQ(v[3], all.at<3>(i, j, k));
        EXPECT_EQ(v[4], all.at<4>(i, j, k));
        EXPECT_EQ(v[5], all.at<5>(i, j, k));
        EXPECT_EQ(v[6], all.at<6>(i, j, k));
        EXPECT_EQ(v[7], all.at<7>(i, j, k));
      }
    }
  }
  ASSERT_TRUE(all.grid.sample<double>({0.5, 1.5, 0.5}, v));
  double sum[2] = {0, 0};
  for (int n = 0; n < 8; ++n) {
    sum[0] += all.at<3>(n & 1, 1 + ((n >> 1) & 1), n >> 2);
    sum[1] += all.at<7>(n & 1, 1 + ((n >> 1) & 1), n >> 2);
  }
  EXPECT_NEAR(v[3], sum[0] / 8, 1e-13);
  EXPECT_NEAR(v[7], sum[1] / 8, 1e-13);
  float single[max_channels];
  ASSERT_TRUE(all.grid.sample<float>({0.5, 1.5, 0.5}, single));
  EXPECT_NEAR(static_cast<double>(single[3]), sum[0] / 8, 1e-5);
}

TEST(MultichannelGrid, PositionsAreClampedIntoTheBox) {
  for (const int padding : {0, 1}) {
    const EveryType all(padding);
    double inside[max_channels], outside[max_channels];
    ASSERT_TRUE(all.grid.sample<double>({0, 0, 1}, inside));
    ASSERT_TRUE(all.grid.sample<double>({-7, -1e30, 1}, outside));
    for (int c = 0; c < 8; ++c) EXPECT_EQ(inside[c], outside[c]) << padding;
    ASSERT_TRUE(all.grid.sample<double>({2, 3, 0}, inside));
    ASSERT_TRUE(all.grid.sample<double>({1e30, 3.4, -0.4}, outside));
    for (int c = 0; c < 8; ++c) EXPECT_EQ(inside[c], outside[c]) << padding;
  }
}

TEST(MultichannelGrid, ANaNCornerOfAnyChannelIsVacuum) {
  EveryType all(0);
  std::get<6>(all.data)[1 + 3 * (1 + 4 * 0)] = std::numeric_limits<float>::quiet_NaN();
  double v[max_channels];
  // The cells with i = 0 or 1 and j = 0 or 1 have that corner; those with j = 2 have not.
  EXPECT_FALSE(all.grid.sample<double>({0.5, 0.5, 0.5}, v));
  EXPECT_FALSE(all.grid.sample<double>({1.9, 1.1, 0.99}, v));
  EXPECT_TRUE(all.grid.sample<double>({0.5, 2.5, 0.5}, v));
  // A channel that is not asked for does not count.
  all.grid.channels = 6;
  EXPECT_TRUE(all.grid.sample<double>({0.5, 0.5, 0.5}, v));
  all.grid.channels = 8;
  std::get<7>(all.data).assign(24, nan);
  EXPECT_FALSE(all.grid.sample<double>({0.5, 2.5, 0.5}, v));
}

/// Values whose sum overflows are no vacuum.
TEST(MultichannelGrid, LargeNumbersAreNoVacuum) {
  const std::vector<double> upper(8, 1.5e308), lower(8, -1.5e308);
  MultichannelGrid grid;
  grid.channels = 4;
  for (int c = 0; c < 4; ++c) {
    grid.data[c] = c < 2 ? upper.data() : lower.data();
    grid.type[c] = ValueType::f64;
  }
  for (GridAxis<double>& axis : grid.axis) axis = {nullptr, 2, 0};
  double v[max_channels];
  EXPECT_TRUE(grid.sample<double>({0, 0, 0}, v));
}

}  // namespace
}  // namespace pellucid::test_multichannel_grid
