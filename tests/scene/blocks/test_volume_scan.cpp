// SPDX-License-Identifier: Apache-2.0
#include "src/scene/blocks/volume_scan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace pellucid::test_volume_scan {
namespace {

template <class Value>
std::vector<Value> random_values(std::size_t count, std::mt19937& random) {
  std::vector<Value> values(count);
  for (Value& v : values) {
    if constexpr (std::is_integral_v<Value>) {
      v = static_cast<Value>(random());
    } else {
      v = static_cast<Value>(std::uniform_real_distribution<double>(-5, 9)(random));
    }
  }
  return values;
}

template <class Value>
class VolumeScanOf : public ::testing::Test {};
using Types = ::testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t,
                               std::uint32_t, std::int32_t, float, double>;
TYPED_TEST_SUITE(VolumeScanOf, Types);

// Lengths that leave a part of a row of lanes, with the extremes at every place.
TYPED_TEST(VolumeScanOf, FindsTheExtremesWhereverTheyStand) {
  std::mt19937 random(1);
  for (const std::size_t count : std::initializer_list<std::size_t>{1, 2, 7, 31, 32, 33, 64, 101}) {
    std::vector<TypeParam> values = random_values<TypeParam>(count, random);
    for (std::size_t i = 0; i < count; ++i) {
      std::rotate(values.begin(), values.begin() + 1, values.end());
      const VolumeScan s = scan(std::span<const TypeParam>(values));
      ASSERT_EQ(s.statistics.minimum, static_cast<double>(*std::ranges::min_element(values)));
      ASSERT_EQ(s.statistics.maximum, static_cast<double>(*std::ranges::max_element(values)));
      ASSERT_EQ(s.statistics.finite, count);
      ASSERT_EQ(s.statistics.nan + s.statistics.infinite, 0u);
      ASSERT_FALSE(s.large);
    }
  }
}

TYPED_TEST(VolumeScanOf, HistogramIsThatOfOneValueAfterTheOther) {
  std::mt19937 random(2);
  for (const std::size_t count : std::initializer_list<std::size_t>{1, 3, 1000, 20001}) {
    const std::vector<TypeParam> values = random_values<TypeParam>(count, random);
    for (const std::size_t bins : std::initializer_list<std::size_t>{1, 24, 256}) {
      Histogram h{static_cast<double>(*std::ranges::min_element(values)),
                  static_cast<double>(*std::ranges::max_element(values)),
                  std::vector<std::uint64_t>(bins)};
      fill_histogram(std::span<const TypeParam>(values), h);
      std::map<std::size_t, std::uint64_t> expected;
      for (const TypeParam v : values) {
        const double x = static_cast<double>(v);
        std::size_t bin = bins - 1;
        if (x < h.upper) {
          bin = std::min(bin, static_cast<std::size_t>((x - h.lower) / (h.upper - h.lower) *
                                                       static_cast<double>(bins)));
        }
        ++expected[bin];
      }
      for (std::size_t bin = 0; bin < bins; ++bin) {
        ASSERT_EQ(h.count[bin], expected[bin]) << bin << " of " << bins << ", " << count;
      }
    }
  }
}

template <class Value>
class VolumeScanOfReal : public ::testing::Test {};
using RealTypes = ::testing::Types<float, double>;
TYPED_TEST_SUITE(VolumeScanOfReal, RealTypes);

TYPED_TEST(VolumeScanOfReal, NanIsCountedAndPassedOver) {
  std::mt19937 random(3);
  const TypeParam nan = std::numeric_limits<TypeParam>::quiet_NaN();
  for (std::size_t place = 0; place < 40; ++place) {
    std::vector<TypeParam> values = random_values<TypeParam>(41, random);
    values[place] = nan;
    std::vector<TypeParam> others = values;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(place));
    const VolumeScan s = scan(std::span<const TypeParam>(values));
    ASSERT_EQ(s.statistics.nan, 1u);
    ASSERT_EQ(s.statistics.finite, 40u);
    ASSERT_EQ(s.statistics.minimum, static_cast<double>(*std::ranges::min_element(others)));
    ASSERT_EQ(s.statistics.maximum, static_cast<double>(*std::ranges::max_element(others)));
  }
  const std::vector<TypeParam> all(37, nan);
  const VolumeScan s = scan(std::span<const TypeParam>(all));
  EXPECT_EQ(s.statistics.nan, 37u);
  EXPECT_EQ(s.statistics.finite, 0u);
  EXPECT_EQ(s.statistics.minimum, 0);
  EXPECT_EQ(s.statistics.maximum, 0);
}

TYPED_TEST(VolumeScanOfReal, TheFirstValueToBlameIsFound) {
  const TypeParam infinity = std::numeric_limits<TypeParam>::infinity();
  for (std::size_t place = 0; place < 70; ++place) {
    std::vector<TypeParam> values(75, TypeParam(1));
    values[place] = values[place + 2] = -infinity;
    const VolumeScan s = scan(std::span<const TypeParam>(values));
    ASSERT_EQ(s.statistics.infinite, 2u);
    ASSERT_EQ(s.statistics.finite, 73u);
    ASSERT_EQ(s.first_infinite, place);

    values[place] = TypeParam(3e37);
    values[place + 2] = TypeParam(-3e37);
    const VolumeScan large = scan(std::span<const TypeParam>(values));
    ASSERT_TRUE(large.large);
    ASSERT_EQ(large.first_large, place);
    ASSERT_EQ(large.statistics.infinite, 0u);
  }
}

TYPED_TEST(VolumeScanOfReal, OfZerosOfBothSignsTheExtremesAreZero) {
  const std::vector<TypeParam> values{TypeParam(-0.0), TypeParam(0.0), TypeParam(-0.0)};
  const VolumeScan s = scan(std::span<const TypeParam>(values));
  EXPECT_FALSE(std::signbit(s.statistics.minimum));
  EXPECT_FALSE(std::signbit(s.statistics.maximum));
}

}  // namespace
}  // namespace pellucid::test_volume_scan
