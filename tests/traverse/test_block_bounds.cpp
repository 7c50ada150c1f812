// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <random>
#include <vector>

#include "block_field.h"
#include "pellucid/traverse/block_ranges.h"
#include "tests/support/wide_functions.h"

// What follows for the data along a ray from the ranges of a block.
namespace pellucid {
namespace {

using test::Wide;

/// The trilinear data by its definition, at grid coordinates of one cell; 64 bits.
template <class Value>
long double data_at(const BlockField<Value>& f, const long double (&p)[3]) {
  int cell[3];
  long double s[3];
  for (int a = 0; a < 3; ++a) {
    const GridAxis<double>& axis = f.grid.axis[a];
    cell[a] = 0;
    while (cell[a] + 1 < axis.cells() && static_cast<long double>(axis.plane(cell[a] + 1)) <= p[a])
      ++cell[a];
    const long double lower = static_cast<long double>(axis.plane(cell[a]));
    s[a] = (p[a] - lower) / (static_cast<long double>(axis.plane(cell[a] + 1)) - lower);
  }
  const auto corners = f.grid.template corners<double>(cell[0], cell[1], cell[2]);
  long double sum = 0;
  for (int n = 0; n < 8; ++n) {
    long double weight = 1;
    for (int a = 0; a < 3; ++a) weight *= ((n >> a) & 1) != 0 ? s[a] : 1 - s[a];
    sum += weight * static_cast<long double>(corners.value[n]);
  }
  return sum;
}

TEST(BlockBounds, HoldTheDataItsSlopesAndItsDeviationFromChords) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> uniform(0, 1);
  double closest_value = 0, closest_slope = 0, closest_chord = 0;
  long stretches = 0;
  for (int g = 0; g < 200; ++g) {
    BlockField<float> f;
    const bool rough = g % 2 == 0;
    for (int a = 0; a < 3; ++a) {
      const int padding = static_cast<int>(random() % 2);
      std::vector<double> planes;
      if (random() % 2 == 0) {
        planes.push_back(uniform(random));
        for (int i = 1; i < 7 + 2 * padding; ++i)
          planes.push_back(planes.back() + 0.1 + uniform(random));
      }
      f.set_axis(a, 7, padding, planes);
    }
    const double p = uniform(random), q = uniform(random), r = uniform(random);
    f.fill([&](int i, int j, int k) {
      return rough ? uniform(random) : std::sin(p * i + q * j) * std::cos(r * k + p * j);
    });
    f.build();
    ASSERT_EQ(f.blocks.count(), 1);
    const BlockRange& range = f.blocks[0];
    const long double scale = 1e-15L;  // of the truth's own rounding
    for (int n = 0; n < 100; ++n) {
      // From one place of the block to another, at times along an axis or in a plane.
      double from[3], to[3];
      for (int a = 0; a < 3; ++a) {
        const double lower = f.block_planes[a].front(), upper = f.block_planes[a].back();
        from[a] = lower + uniform(random) * (upper - lower);
        to[a] = random() % 4 == 0 ? from[a] : lower + uniform(random) * (upper - lower);
      }
      const double length = 0.1 + uniform(random);  // of the ray's parameter
      const Vec3<double> direction{(to[0] - from[0]) / length, (to[1] - from[1]) / length,
                                   (to[2] - from[2]) / length};
      const Interval<double> slope = derivative_range(range, direction);
      ASSERT_LE(slope.begin, slope.end);
      constexpr int count = 64;
      long double value[count + 1];
      for (int i = 0; i <= count; ++i) {
        long double at[3];
        for (int a = 0; a < 3; ++a) {
          at[a] = static_cast<long double>(from[a]) + static_cast<long double>(length) * i / count *
                                                          static_cast<long double>(direction[a]);
        }
        value[i] = data_at(f, at);
        ASSERT_GE(value[i], static_cast<long double>(range.min) - scale);
        ASSERT_LE(value[i], static_cast<long double>(range.max) + scale);
      }
      const double bound = chord_deviation(slope, length);
      for (int i = 0; i <= count; ++i) {
        const long double chord = value[0] + (value[count] - value[0]) * i / count;
        ASSERT_LE(std::abs(value[i] - chord), static_cast<long double>(bound) + scale);
        if (bound > 0) {
          closest_chord =
              std::max(closest_chord, static_cast<double>(std::abs(value[i] - chord)) / bound);
        }
        if (i == 0) continue;
        // The mean slope between two places is one that the data has (or a mean of such).
        const long double mean =
            (value[i] - value[i - 1]) * count / static_cast<long double>(length);
        ASSERT_GE(mean, static_cast<long double>(slope.begin) - 1e3L * scale);
        ASSERT_LE(mean, static_cast<long double>(slope.end) + 1e3L * scale);
        if (slope.end > 0) {
          closest_slope = std::max(closest_slope, static_cast<double>(mean) / slope.end);
        }
        closest_value =
            std::max(closest_value, static_cast<double>(value[i]) / static_cast<double>(range.max));
      }
      ++stretches;
    }
  }
  std::cout << stretches << " stretches; of their bounds the values reached " << closest_value
            << ", the slopes " << closest_slope << ", the deviations " << closest_chord << "\n";
  EXPECT_GT(closest_value, 0.9);
  EXPECT_GT(closest_slope, 0.9);
  EXPECT_GT(closest_chord, 0.5);
}

TEST(BlockBounds, AHatReachesTheBoundOfChords) {
  // |x - 4| over 8 cells: slopes -1 and 1, 4 below its chord in the middle.
  BlockField<std::uint8_t> f;
  f.set_axis(0, 9, 0);
  f.set_axis(1, 3, 0);
  f.set_axis(2, 3, 0);
  f.fill([](int i, int, int) { return std::abs(i - 4); });
  f.build();
  const Interval<double> slope = derivative_range(f.blocks[0], {1, 0.3, -0.7});
  EXPECT_NEAR(slope.begin, -1, 1e-15);
  EXPECT_NEAR(slope.end, 1, 1e-15);
  EXPECT_NEAR(chord_deviation(slope, 8), 4, 1e-14);
  EXPECT_GE(chord_deviation(slope, 8), 4);
}

TEST(BlockBounds, DerivativeRangeOfKnownRanges) {
  const BlockRange r{0, 1, {-1, 2, 0}, {3, 5, 0}, BlockVacuum::none};
  const Interval<double> d = derivative_range(r, {2, -1, 7});
  EXPECT_LE(d.begin, -2 - 5);
  EXPECT_NEAR(d.begin, -7, 1e-14);
  EXPECT_GE(d.end, 6 - 2);
  EXPECT_NEAR(d.end, 4, 1e-14);
  const Interval<double> none = derivative_range(r, {0, -0.0, 7});
  EXPECT_EQ(none.begin, 0);
  EXPECT_EQ(none.end, 0);
}

TEST(BlockBounds, DerivativeRangeIsRoundedOutward) {
  std::mt19937 random(10);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (int n = 0; n < 50000; ++n) {
    BlockRange r{};
    Vec3<double> d;
    Wide lower = 0, upper = 0;
    for (int a = 0; a < 3; ++a) {
      const float p = uniform(random), q = uniform(random);
      r.derivative_min[a] = std::min(p, q);
      r.derivative_max[a] = std::max(p, q);
      d[a] = static_cast<double>(uniform(random)) / 3;
      const Wide x = Wide(d[a]) * Wide(p);
      const Wide y = Wide(d[a]) * Wide(q);
      lower += std::min(x, y);
      upper += std::max(x, y);
    }
    const Interval<double> range = derivative_range(r, d);
    ASSERT_LE(Wide(range.begin), lower);
    ASSERT_GE(Wide(range.end), upper);
    ASSERT_NEAR(range.begin, static_cast<double>(lower), 1e-14);
    ASSERT_NEAR(range.end, static_cast<double>(upper), 1e-14);
  }
}

}  // namespace
}  // namespace pellucid
