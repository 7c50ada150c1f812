// SPDX-License-Identifier: Apache-2.0
#include "pellucid/traverse/build_block_records.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iostream>
#include <limits>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include "block_field.h"
#include "tests/support/wide_functions.h"

namespace pellucid::test_block_records {
namespace {

using test::Wide;

constexpr float float_infinity = std::numeric_limits<float>::infinity();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// The data of some cells, the derivatives along the axes and how these change, by definition.
struct WideBlock {
  Wide lower, upper;
  Wide slope_min[3], slope_max[3], second_difference[3], twist[3];
  Wide largest = 0;
  int cells = 0, solid = 0;
};

/// The width of a cell.
template <class Value>
Wide width(const StructuredGrid<Value, double>& grid, int a, int n) {
  return Wide(grid.axis[a].plane(n + 1)) - Wide(grid.axis[a].plane(n));
}
template <class Value>
Wide corner(const StructuredGrid<Value, double>& grid, const int (&n)[3]) {
  const Value v =
      grid.data[grid.offset(grid.axis[0].value_index(n[0]), grid.axis[1].value_index(n[1]),
                            grid.axis[2].value_index(n[2]))];
  return Wide(v);
}
/// The derivative along axis a of the edge that begins at a corner.
template <class Value>
Wide slope(const StructuredGrid<Value, double>& grid, int a, const int (&n)[3]) {
  int m[3] = {n[0], n[1], n[2]};
  ++m[a];
  return (corner(grid, m) - corner(grid, n)) / width(grid, a, n[a]);
}

/// A block, cell by cell and corner by corner.
template <class Value>
WideBlock wide_block(const StructuredGrid<Value, double>& grid, const int (&first)[3],
                     const int (&last)[3]) {
  WideBlock w;
  for (int a = 0; a < 3; ++a) w.second_difference[a] = w.twist[a] = 0;
  int n[3];
  for (n[2] = first[2]; n[2] <= last[2]; ++n[2]) {
    for (n[1] = first[1]; n[1] <= last[1]; ++n[1]) {
      for (n[0] = first[0]; n[0] <= last[0]; ++n[0]) {
        if (const Wide v = corner(grid, n); !isnan(v))
          w.largest = std::max(w.largest, Wide(abs(v)));
        for (int a = 0; a < 3; ++a) {
          const int b = (a + 1) % 3, c = (a + 2) % 3;
          // Across the plane through this corner, if it has cells on both sides.
          if (n[a] > first[a] && n[a] < grid.axis[a].cells()) {
            int before[3] = {n[0], n[1], n[2]};
            --before[a];
            const Wide second_difference = abs(slope(grid, a, n) - slope(grid, a, before));
            if (!isnan(second_difference))
              w.second_difference[a] = std::max(w.second_difference[a], second_difference);
          }
          if (n[b] < last[b] && n[c] < last[c]) {
            int beside[3] = {n[0], n[1], n[2]};
            ++beside[c];
            const Wide twist =
                abs((slope(grid, b, beside) - slope(grid, b, n)) / width(grid, c, n[c]));
            if (!isnan(twist)) w.twist[a] = std::max(w.twist[a], twist);
          }
        }
        if (n[0] == last[0] || n[1] == last[1] || n[2] == last[2]) continue;
        ++w.cells;
        bool vacuum = false;
        for (int m = 0; m < 8; ++m) {
          const int at[3] = {n[0] + (m & 1), n[1] + (m >> 1 & 1), n[2] + (m >> 2)};
          vacuum = vacuum || isnan(corner(grid, at));
        }
        if (vacuum) continue;
        for (int m = 0; m < 8; ++m) {
          const int at[3] = {n[0] + (m & 1), n[1] + (m >> 1 & 1), n[2] + (m >> 2)};
          const Wide v = corner(grid, at);
          w.lower = w.solid == 0 && m == 0 ? v : std::min(w.lower, v);
          w.upper = w.solid == 0 && m == 0 ? v : std::max(w.upper, v);
          for (int a = 0; a < 3; ++a) {
            if ((m >> a & 1) != 0) continue;
            const Wide d = slope(grid, a, at);
            const bool is_first = w.solid == 0 && m == 0;
            w.slope_min[a] = is_first ? d : std::min(w.slope_min[a], d);
            w.slope_max[a] = is_first ? d : std::max(w.slope_max[a], d);
          }
        }
        ++w.solid;
      }
    }
  }
  return w;
}

/// Whether the bound holds, and is not more than 1/128 above the truth where that is not rounded.
bool just_above(double bound, const Wide& x, const Wide& rounding) {
  if (std::isinf(bound)) return x > 3.3e38;
  return Wide(bound) >= x && Wide(bound) <= (x + rounding) * (1 + Wide(1) / 128) + 1e-39;
}

/// A block against its cells, in 60 digits. Empty: it is as it must be.
template <class Value>
std::string check(const BlockField<Value>& f, int block) {
  const int nx = f.blocks.axis[0].cells(), ny = f.blocks.axis[1].cells();
  const int place[3] = {block % nx, block / nx % ny, block / nx / ny};
  int first[3], last[3];
  for (int a = 0; a < 3; ++a) {
    first[a] = place[a] * 8;
    last[a] = std::min(first[a] + 8, f.grid.axis[a].cells());
  }
  const WideBlock truth = wide_block(f.grid, first, last);
  const BlockRange r = f.blocks.range(block);
  const CurvatureBounds bends = f.blocks.curvature(block);
  if (r.vacuum != (truth.solid == truth.cells ? BlockVacuum::none
                   : truth.solid == 0         ? BlockVacuum::all
                                              : BlockVacuum::some)) {
    return "vacuum";
  }
  if (r.vacuum != BlockVacuum::none &&
      !(std::isinf(bends.second_difference[0]) && std::isinf(bends.twist[2]))) {
    return "bends beside vacuum";
  }
  if (truth.solid == 0) return r.oscillation[0] == 0 ? "" : "not zero where all is vacuum";
  const BlockCode& code = f.blocks.code;
  const Wide step = Wide(code.step) + Wide(truth.largest) * 1e-15;
  if (Wide(r.min) > truth.lower || Wide(r.min) + step < truth.lower) return "min";
  if (Wide(r.max) < truth.upper || Wide(r.max) - step > truth.upper) return "max";
  if (code.step == 1 && (Wide(r.min) != truth.lower || Wide(r.max) != truth.upper)) {
    return "not exact for whole numbers";
  }
  if (r.constant != (truth.solid == truth.cells && truth.lower == truth.upper)) return "constant";
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    Wide inverse[3];
    for (int d = 0; d < 3; ++d) {
      for (int n = first[d]; n <= last[d] && n < f.grid.axis[d].cells(); ++n) {
        inverse[d] = std::max(inverse[d], Wide(1 / width(f.grid, d, n)));
      }
    }
    const Wide rounding = truth.largest * 1e-12;
    const Wide oscillation = truth.slope_max[a] - truth.slope_min[a];
    const double kept = static_cast<double>(r.oscillation[a]);
    if (!just_above(kept, oscillation, rounding * inverse[a])) return "oscillation";
    if (oscillation == 0 && truth.slope_max[a] == 0 && kept != 0) return "oscillation of nothing";
    if (r.vacuum != BlockVacuum::none) continue;
    if (!just_above(static_cast<double>(bends.second_difference[a]), truth.second_difference[a],
                    rounding * inverse[a])) {
      return "second_difference";
    }
    if (!just_above(static_cast<double>(bends.twist[a]), truth.twist[a],
                    rounding * inverse[b] * inverse[c])) {
      return "twist";
    }
  }
  return "";
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
class BlockRecordsOf : public testing::Test {};
using Values = testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::uint32_t,
                              std::int32_t, float, double>;
TYPED_TEST_SUITE(BlockRecordsOf, Values);

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

TYPED_TEST(BlockRecordsOf, HoldTheCellsAndNoMore) {
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

TYPED_TEST(BlockRecordsOf, WholeBlocksOfUniformGrids) {
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

TEST(BlockRecords, QuotientsNearFloatsStayBounds) {
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

TEST(BlockRecords, DerivativesBeyondFloatAreUnbounded) {
  BlockField<double> f;
  f.set_axis(0, 2, 0, {0, 1e-300});
  f.set_axis(1, 2, 0);
  f.set_axis(2, 2, 0, {0, 1e300});
  f.fill([](int i, int, int k) { return i + 1e-30 * k; });
  f.build();
  const BlockRange r = f.blocks.range(0);
  EXPECT_EQ(r.oscillation[0], float_infinity);
  EXPECT_EQ(r.oscillation[1], 0);
  EXPECT_GT(r.oscillation[2], 0);
  // Along the others the ray still has bounds.
  EXPECT_EQ(derivative_oscillation(r, {0, 1, 0}), 0);
  EXPECT_EQ(derivative_oscillation(r, {1, 0, 0}), infinity);
}

TEST(BlockRecords, CellsTooNarrowToDivideByAreUnboundedBesideVacuumToo) {
  for (const bool vacuum : {false, true}) {
    BlockField<double> f;
    f.set_axis(0, 5, 0, {0, 1e-310, 1, 2, 3});
    f.set_axis(1, 3, 0);
    f.set_axis(2, 2, 0);
    f.fill([vacuum](int i, int j, int) {
      return vacuum && i == 4 && j == 2 ? std::nan("") : i * 1.0 + j;
    });
    f.build();
    EXPECT_EQ(f.blocks.range(0).oscillation[0], float_infinity);
    EXPECT_EQ(f.blocks.curvature(0).second_difference[0], float_infinity);
    EXPECT_EQ(f.blocks.curvature(0).twist[2], float_infinity);
    EXPECT_LT(f.blocks.range(0).oscillation[1], 1e-10f);
  }
}

TEST(BlockCode, HoldsEveryDatumBetweenItsCodes) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform(0, 1);
  double widest = 0;
  for (int n = 0; n < 2000; ++n) {
    // From denormal to the largest that a volume may have; at times a few rounding errors wide.
    const double scale = std::ldexp(1, static_cast<int>(random() % 1190) - 1070);
    double minimum = scale * (uniform(random) - 0.5);
    double maximum = minimum + scale * uniform(random);
    if (n % 4 == 0) maximum = minimum;
    for (unsigned i = 0; n % 4 == 0 && i < random() % 20; ++i) {
      maximum = std::nextafter(maximum, infinity);
    }
    const BlockCode code = make_block_code(minimum, maximum, false);
    ASSERT_EQ(code.value(0), minimum);
    ASSERT_GE(code.value(code.last), maximum);
    ASSERT_TRUE(std::isfinite(code.value(code.last)));
    for (int m = 0; m < 50; ++m) {
      double x = minimum + (maximum - minimum) * uniform(random);
      if (m == 0) x = minimum;
      if (m == 1) x = maximum;
      // On the number of a code and beside it, where a quotient may be rounded either way.
      if (m > 10) x = code.value(static_cast<int>(random() % 65536));
      if (m > 20) x = std::nextafter(x, m > 35 ? infinity : -infinity);
      x = std::clamp(x, minimum, maximum);
      const int below = code_below(code, x), above = code_above(code, x);
      ASSERT_LE(below, above);
      ASSERT_LE(code.value(below), x) << minimum << " " << maximum;
      ASSERT_GE(code.value(above), x) << minimum << " " << maximum;
      const double rounding = 4e-16 * std::max(std::abs(minimum), std::abs(maximum)) + 5e-324;
      const double most = code.step + 2 * rounding;
      widest = std::max({widest, (x - code.value(below)) / most, (code.value(above) - x) / most});
    }
  }
  EXPECT_LE(widest, 1);
}

TEST(BlockCode, IsExactForWholeNumbers) {
  for (const double minimum : {0.0, -128.0, -32768.0, 4294901760.0, -2147483648.0}) {
    for (const int range : {0, 1, 255, 4095, 65535}) {
      const BlockCode code = make_block_code(minimum, minimum + range, true);
      ASSERT_EQ(code.last, range);
      for (int c = 0; c <= range; ++c) {
        ASSERT_EQ(code_below(code, minimum + c), c);
        ASSERT_EQ(code_above(code, minimum + c), c);
        ASSERT_EQ(code.value(c), minimum + c);
      }
    }
  }
  EXPECT_EQ(make_block_code(0, 65536, true).last, 65535);
  EXPECT_EQ(make_block_code(3, 3, false).last, 0);
}

TEST(UpperHalf, IsTheLeastAbove) {
  EXPECT_EQ(upper_half_above(0), 0);
  EXPECT_EQ(upper_half_above(-0.0), 0);
  EXPECT_EQ(from_upper_half(upper_half_above(1)), 1);
  EXPECT_EQ(from_upper_half(upper_half_above(infinity)), float_infinity);
  EXPECT_EQ(from_upper_half(upper_half_above(3.4e38)), float_infinity);
  EXPECT_EQ(from_upper_half(upper_half_above(1e300)), float_infinity);
  EXPECT_EQ(from_upper_half(upper_half_above(std::nan(""))), float_infinity);
  std::mt19937_64 random(12);
  for (int n = 0; n < 1000000; ++n) {
    const double x = std::ldexp(1 + static_cast<double>(random() >> 11) * 0x1p-53,
                                static_cast<int>(random() % 300) - 160);
    const std::uint16_t half = upper_half_above(x);
    ASSERT_GE(static_cast<double>(from_upper_half(half)), x);
    if (half > 1 && x > 0x1p-124) {
      ASSERT_LT(static_cast<double>(from_upper_half(static_cast<std::uint16_t>(half - 1))), x);
    }
  }
}

TEST(BlockRecords, AreAtMostATwentiethOfTheData) {
  for (const int padding : {0, 1}) {  // half cells at both ends make a block more
    const double blocks = std::pow(block_count(GridAxis<double>{nullptr, 512, padding}), 3);
    std::cout << blocks * sizeof(BlockRecord) / std::pow(512, 3) << " bytes a value\n";
    EXPECT_LE(blocks * sizeof(BlockRecord), 0.05 * std::pow(512, 3));
  }
}

TEST(BlockRecords, SmallestDifferencesDoNotVanish) {
  for (const double step : {5e-324, 1e-310, 1e-45, 1e-40}) {
    BlockField<double> f;
    f.set_cube(3, 0);
    f.fill([step](int i, int j, int k) { return i == 1 && j == 1 && k == 1 ? step : 0.0; });
    f.build();
    EXPECT_EQ(check(f), "") << step;
    EXPECT_FALSE(f.blocks.range(0).constant);
    EXPECT_GT(f.blocks.range(0).max, 0);
  }
}

TEST(BlockRecords, ConstantToTheLastBit) {
  BlockField<double> f;
  f.set_cube(9, 1);
  f.fill([](int, int, int) { return 0.1; });
  f.build();
  for (int b = 0; b < f.blocks.count(); ++b) EXPECT_TRUE(f.blocks.range(b).constant);
  EXPECT_EQ(f.blocks.range(0).min, 0.1);
  EXPECT_EQ(f.blocks.range(0).max, 0.1);
  f.data[4] = std::nextafter(0.1, 1);
  f.build();
  EXPECT_FALSE(f.blocks.range(0).constant);
  f.data[4] = std::numeric_limits<double>::quiet_NaN();
  f.build();
  EXPECT_FALSE(f.blocks.range(0).constant);
  EXPECT_EQ(f.blocks.range(0).vacuum, BlockVacuum::some);
}

TEST(BlockRecords, PartsInAnyOrderAreTheWhole) {
  BlockField<std::int16_t> f;
  std::mt19937 random(8);
  f.set_axis(0, 30, 0);
  f.set_axis(1, 19, 1);
  f.set_axis(2, 11, 0);
  fill_random(f, random, 0);
  f.build();
  const int count = f.blocks.count();
  std::vector<BlockRecord> parts(f.record.size());
  const auto build = [&](int first, int last) {
    build_block_records(f.grid, f.blocks.axis, f.blocks.code, first, last, parts.data());
  };
  build(5, count);
  build(5, 5);
  build(0, 5);
  EXPECT_EQ(std::memcmp(parts.data(), f.record.data(), parts.size() * sizeof(BlockRecord)), 0);
}

}  // namespace
}  // namespace pellucid::test_block_records
