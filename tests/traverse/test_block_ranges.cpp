// SPDX-License-Identifier: Apache-2.0
#include "pellucid/traverse/block_ranges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include "block_field.h"
#include "tests/support/wide_functions.h"

namespace pellucid {
namespace {

using test::Wide;

constexpr float float_infinity = std::numeric_limits<float>::infinity();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Whether `bound` is at most x and no more than `floats` floats further down than need be.
bool just_below(float bound, const Wide& x, int floats) {
  if (Wide(bound) > x) return false;
  for (int n = 0; n < floats; ++n) bound = std::nextafter(bound, float_infinity);
  return bound == float_infinity || Wide(bound) > x;
}
bool just_above(float bound, const Wide& x, int floats) {
  return just_below(-bound, -x, floats);
}

/// Of the data of some cells and of its derivatives along the three axes.
struct WideRange {
  Wide lower[4], upper[4];
  int cells = 0, solid = 0;

  template <class Value>
  void add(const StructuredGrid<Value, double>& grid, int i, int j, int k) {
    const auto corners = grid.template corners<double>(i, j, k);
    const double* const v = corners.value;
    ++cells;
    if (std::any_of(v, v + 8, [](double x) { return std::isnan(x); })) return;
    if (solid++ == 0) std::fill(lower, lower + 4, 1e300);
    if (solid == 1) std::fill(upper, upper + 4, -1e300);
    const int cell[3] = {i, j, k};
    for (int n = 0; n < 8; ++n) {
      include(0, Wide(v[n]));
      for (int a = 0; a < 3; ++a) {
        if (((n >> a) & 1) != 0) continue;
        const GridAxis<double>& axis = grid.axis[a];
        include(a + 1, (Wide(v[n + (1 << a)]) - Wide(v[n])) /
                           (Wide(axis.plane(cell[a] + 1)) - Wide(axis.plane(cell[a]))));
      }
    }
  }
  void include(int which, const Wide& x) {
    lower[which] = std::min(lower[which], x);
    upper[which] = std::max(upper[which], x);
  }
};

/// A block against its cells, one by one, in 60 digits. Empty: it is as it must be.
template <class Value>
std::string check(const BlockField<Value>& f, int block) {
  const int nx = f.blocks.axis[0].cells(), ny = f.blocks.axis[1].cells();
  const int place[3] = {block % nx, block / nx % ny, block / nx / ny};
  int first[3], last[3];
  for (int a = 0; a < 3; ++a) {
    first[a] = place[a] * 8;
    last[a] = std::min(first[a] + 8, f.grid.axis[a].cells());
  }
  WideRange truth;
  for (int k = first[2]; k < last[2]; ++k) {
    for (int j = first[1]; j < last[1]; ++j) {
      for (int i = first[0]; i < last[0]; ++i) truth.add(f.grid, i, j, k);
    }
  }
  const BlockRange& r = f.blocks[block];
  if (r.vacuum != (truth.solid == truth.cells ? BlockVacuum::none
                   : truth.solid == 0         ? BlockVacuum::all
                                              : BlockVacuum::some)) {
    return "vacuum";
  }
  if (truth.solid == 0) {
    bool zero = r.min == 0 && r.max == 0;
    for (int a = 0; a < 3; ++a) {
      zero = zero && r.derivative_min[a] == 0 && r.derivative_max[a] == 0;
    }
    return zero ? "" : "not zero where all is vacuum";
  }
  if (!just_below(r.min, truth.lower[0], 1)) return "min";
  if (!just_above(r.max, truth.upper[0], 1)) return "max";
  bool flat = truth.solid == truth.cells;
  for (int a = 0; a < 3; ++a) {
    const Wide &lower = truth.lower[a + 1], &upper = truth.upper[a + 1];
    // One more where the bound of the quotient's rounding reaches over a float.
    if (!just_below(r.derivative_min[a], lower, 2)) return "derivative_min";
    if (!just_above(r.derivative_max[a], upper, 2)) return "derivative_max";
    if (std::is_integral_v<Value> && sizeof(Value) < 4 &&
        f.grid.axis[a].plane_position == nullptr &&
        (Wide(r.derivative_min[a]) != lower || Wide(r.derivative_max[a]) != upper)) {
      return "not exact for integers";
    }
    flat = flat && lower == 0 && upper == 0;
  }
  return r.constant() == flat ? "" : "constant()";
}

template <class Value>
std::string check(const BlockField<Value>& f) {
  for (int b = 0; b < f.blocks.count(); ++b) {
    const std::string failure = check(f, b);
    if (!failure.empty()) return "block " + std::to_string(b) + ": " + failure;
  }
  return "";
}

TEST(FloatBelow, IsTheLargestFloatNotAbove) {
  std::mt19937_64 random(3);
  const auto check_one = [](double x) {
    const float f = float_below(x);
    ASSERT_LE(static_cast<double>(f), x) << x;
    ASSERT_EQ(float_above(-x), -f) << x;
    if (x > static_cast<double>(std::numeric_limits<float>::max())) {
      ASSERT_EQ(f, std::numeric_limits<float>::max());
      return;
    }
    float next = std::nextafter(f, float_infinity);
    // Between these Rump's formula may go one further down.
    if (std::abs(x) >= 0x1p-127 && std::abs(x) <= 0x1p-124 && static_cast<double>(next) <= x)
      next = std::nextafter(next, float_infinity);
    ASSERT_GT(static_cast<double>(next), x) << x;
  };
  for (const double x : {0.0, -0.0, 1.0, 0.1, 1e-46, 1e-45, 0x1p-149, 0x1p-126, 0x1.8p-126, 1e-300,
                         5e-324, 3.4028234663852886e38, 3.5e38, 1e300, infinity}) {
    check_one(x);
    check_one(-x);
  }
  for (int n = 0; n < 1000000; ++n) {
    const std::uint64_t r = random();
    const int exponent = static_cast<int>(r % 300) - 160;
    const double x = std::ldexp(1 + static_cast<double>(r >> 11) * 0x1p-53, exponent);
    check_one(x);
    check_one(-x);
    const auto f = static_cast<double>(static_cast<float>(x));
    check_one(f);
    check_one(std::nextafter(f, 0));
    check_one(std::nextafter(f, infinity));
  }
}

template <class Value>
class BlockRangesOf : public testing::Test {};
using Values = testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::uint32_t,
                              std::int32_t, float, double>;
TYPED_TEST_SUITE(BlockRangesOf, Values);

/// Values over all of the type, and smooth ones, which a wrong corner shows up in as well.
template <class Value>
void fill_random(BlockField<Value>& f, std::mt19937& random, double nan_share) {
  using Limits = std::numeric_limits<Value>;
  const auto kind = static_cast<int>(random() % 3);
  std::uniform_real_distribution<double> uniform(0, 1);
  f.fill([&](int i, int j, int k) -> double {
    if (!std::is_integral_v<Value>) {
      if (uniform(random) < nan_share) return std::numeric_limits<double>::quiet_NaN();
      if (kind == 0)
        return std::ldexp(uniform(random) - 0.5, static_cast<int>(random() % 200) - 100);
    } else if (kind == 0) {
      const double ends[] = {static_cast<double>(Limits::min()),
                             static_cast<double>(Limits::max())};
      if (random() % 8 == 0) return ends[random() % 2];
      return std::floor(ends[0] + uniform(random) * (ends[1] - ends[0]));
    }
    if (kind == 1) return 3 * i + 2 * j - k < 0 ? 0 : (3 * i + 2 * j - k) % 120;
    return 7;
  });
}

TYPED_TEST(BlockRangesOf, HoldTheCellsAndNoMore) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int g = 0; g < 40; ++g) {
    BlockField<TypeParam> f;
    for (int a = 0; a < 3; ++a) {
      const int padding = static_cast<int>(random() % 2);
      const int values = 1 + static_cast<int>(random() % 19) + (padding == 0 ? 1 : 0);
      std::vector<double> planes;
      if (random() % 2 == 0) {
        planes.push_back(uniform(random) - 3);
        for (int i = 1; i < values + 2 * padding; ++i) {
          planes.push_back(planes.back() + std::pow(10, 3 * uniform(random) - 2));
        }
      }
      f.set_axis(a, values, padding, planes);
    }
    fill_random(f, random, g % 3 == 0 ? 0 : g % 3 == 1 ? 0.01 : 0.4);
    f.build();
    ASSERT_EQ(check(f), "") << "grid " << g;
  }
}

TYPED_TEST(BlockRangesOf, WholeBlocksOfUniformGrids) {
  std::mt19937 random(6);
  for (const int padding : {0, 1}) {
    for (int g = 0; g < 3; ++g) {
      BlockField<TypeParam> f;
      f.set_cube(17, padding);
      fill_random(f, random, 0);
      f.build();
      ASSERT_EQ(check(f), "") << "grid " << g;
    }
  }
}

TEST(BlockRanges, QuotientsNearFloatsStayBounds) {
  // Widths w with 1/w within a rounding error of a float: the quotient in double is that float or
  // beside it, on either side of the truth. Widths that are themselves rounded, as well.
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(0.5f, 2.0f);
  for (int n = 0; n < 20000; ++n) {
    const double w = 1 / static_cast<double>(uniform(random));
    const double shift = n % 2 == 0 ? 0.0 : static_cast<double>(uniform(random));
    BlockField<std::uint8_t> f;
    f.set_axis(0, 2, 0, {shift, shift + w});
    f.set_axis(1, 2, 0);
    f.set_axis(2, 2, 0);
    f.fill([n](int i, int, int) { return n % 4 < 2 ? i : 1 - i; });
    f.build();
    ASSERT_EQ(check(f), "") << w << " " << shift;
  }
}

TEST(BlockRanges, DerivativesBeyondFloatAreUnbounded) {
  BlockField<double> f;
  f.set_axis(0, 2, 0, {0, 1e-300});
  f.set_axis(1, 2, 0);
  f.set_axis(2, 2, 0, {0, 1e300});
  f.fill([](int i, int, int k) { return i + 1e-30 * k; });
  f.build();
  const BlockRange& r = f.blocks[0];
  EXPECT_EQ(r.derivative_min[0], std::numeric_limits<float>::max());
  EXPECT_EQ(r.derivative_max[0], float_infinity);
  EXPECT_EQ(r.derivative_min[1], 0);
  EXPECT_LE(r.derivative_min[2], 0);
  EXPECT_GT(r.derivative_max[2], 0);
  // Along the others the ray still has bounds.
  const Interval<double> d = derivative_range(r, {0, 1, 0});
  EXPECT_EQ(d.begin, 0);
  EXPECT_EQ(d.end, 0);
  EXPECT_EQ(derivative_range(r, {1, 0, 0}).end, infinity);
  EXPECT_EQ(derivative_range(r, {-1, 0, 0}).begin, -infinity);
}

TEST(BlockRanges, SmallestDifferencesDoNotVanish) {
  for (const double step : {5e-324, 1e-310, 1e-45, 1e-40}) {
    BlockField<double> f;
    f.set_cube(3, 0);
    f.fill([step](int i, int j, int k) { return i == 1 && j == 1 && k == 1 ? step : 0.0; });
    f.build();
    EXPECT_EQ(check(f), "") << step;
    EXPECT_FALSE(f.blocks[0].constant());
    EXPECT_GT(f.blocks[0].max, 0);
  }
}

TEST(BlockRanges, ConstantToTheLastBit) {
  BlockField<double> f;
  f.set_cube(9, 1);
  f.fill([](int, int, int) { return 0.1; });
  f.build();
  for (int b = 0; b < f.blocks.count(); ++b) EXPECT_TRUE(f.blocks[b].constant());
  EXPECT_LT(static_cast<double>(f.blocks[0].min), 0.1);
  EXPECT_GT(static_cast<double>(f.blocks[0].max), 0.1);
  f.data[4] = std::nextafter(0.1, 1);
  f.build();
  EXPECT_FALSE(f.blocks[0].constant());
  f.data[4] = std::numeric_limits<double>::quiet_NaN();
  f.build();
  EXPECT_FALSE(f.blocks[0].constant());
  EXPECT_EQ(f.blocks[0].vacuum, BlockVacuum::some);
}

TEST(BlockRanges, PartsInAnyOrderAreTheWhole) {
  BlockField<std::int16_t> f;
  std::mt19937 random(8);
  f.set_axis(0, 30, 0);
  f.set_axis(1, 19, 1);
  f.set_axis(2, 11, 0);
  fill_random(f, random, 0);
  f.build();
  const int count = f.blocks.count();
  std::vector<BlockRange> parts(f.range.size());
  build_block_ranges(f.grid, f.blocks.axis, 5, count, parts.data());
  build_block_ranges(f.grid, f.blocks.axis, 5, 5, parts.data());
  build_block_ranges(f.grid, f.blocks.axis, 0, 5, parts.data());
  for (std::size_t b = 0; b < parts.size(); ++b) {
    EXPECT_EQ(parts[b].min, f.range[b].min);
    EXPECT_EQ(parts[b].max, f.range[b].max);
    for (int a = 0; a < 3; ++a) {
      EXPECT_EQ(parts[b].derivative_min[a], f.range[b].derivative_min[a]);
      EXPECT_EQ(parts[b].derivative_max[a], f.range[b].derivative_max[a]);
    }
  }
}

}  // namespace
}  // namespace pellucid
