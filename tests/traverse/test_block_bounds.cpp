// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <limits>
#include <random>
#include <vector>

#include "block_field.h"
#include "pellucid/traverse/block_records.h"
#include "tests/support/wide_functions.h"

// What follows for the data along a ray from the ranges of a block.
namespace pellucid::test_block_bounds {
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
    const BlockRange range = f.blocks.range(0);
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
      const double oscillation = derivative_oscillation(range, direction);
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
      const double bound = bend_deviation(oscillation, length);
      long double least = 1e300L, most = -1e300L;
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
        least = std::min(least, mean);
        most = std::max(most, mean);
        closest_value =
            std::max(closest_value, static_cast<double>(value[i]) / static_cast<double>(range.max));
      }
      ASSERT_LE(most - least, static_cast<long double>(oscillation) + 1e3L * scale);
      if (oscillation > 0) {
        closest_slope = std::max(closest_slope, static_cast<double>(most - least) / oscillation);
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
  const double oscillation = derivative_oscillation(f.blocks.range(0), {1, 0.3, -0.7});
  EXPECT_NEAR(oscillation, 2, 1e-14);
  EXPECT_NEAR(bend_deviation(oscillation, 8), 4, 1e-13);
  EXPECT_GE(bend_deviation(oscillation, 8), 4);
}

TEST(BlockBounds, OscillationOfKnownRanges) {
  const BlockRange r{
      0, 1, {4, 3, std::numeric_limits<float>::infinity()}, BlockVacuum::none, false};
  EXPECT_NEAR(derivative_oscillation(r, {2, -1, 0}), 11, 1e-13);
  EXPECT_GE(derivative_oscillation(r, {2, -1, -0.0}), 11);
  EXPECT_TRUE(std::isinf(derivative_oscillation(r, {0, 0, 1e-3})));
}

TEST(BlockBounds, OscillationIsRoundedUpward) {
  std::mt19937 random(10);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (int n = 0; n < 50000; ++n) {
    BlockRange r{};
    Vec3<double> d;
    Wide sum = 0;
    for (int a = 0; a < 3; ++a) {
      r.oscillation[a] = uniform(random);
      d[a] = static_cast<double>(0.5f - uniform(random)) / 3;
      sum += abs(Wide(d[a])) * Wide(r.oscillation[a]);
    }
    const double bound = derivative_oscillation(r, d);
    ASSERT_GE(Wide(bound), sum);
    ASSERT_NEAR(bound, static_cast<double>(sum), 1e-14);
  }
}

}  // namespace
}  // namespace pellucid::test_block_bounds
