// SPDX-License-Identifier: Apache-2.0
#include "pellucid/transfer/antiderivative.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "pellucid/scene/internal/antiderivative_storage.h"
#include "tests/support/accuracy.h"

namespace pellucid::test_antiderivative {
namespace {

using test::ErrorRecord;
using Real = long double;

template <class T>
class Antiderivative : public testing::Test {};
using NumberTypes = testing::Types<float, double>;
TYPED_TEST_SUITE(Antiderivative, NumberTypes);

template <class T>
struct Points {
  std::vector<T> value;
  std::vector<Material<T>> material;
  PiecewiseLinear<T> view() const {
    return {value.data(), material.data(), static_cast<int>(value.size())};
  }
};

/// Steps, plateaus, clear stretches, jumps and a peak that holds nearly all of the mass.
template <class T>
Points<T> random_points(std::mt19937_64& random, int count) {
  std::uniform_real_distribution<double> unit(0, 1);
  const auto draw = [&] { return static_cast<T>(unit(random)); };
  Points<T> points;
  double x = unit(random) - 0.5;
  for (int i = 0; i < count; ++i) {
    const bool jump = i > 0 && unit(random) < 0.1 &&
                      (i < 2 || points.value[static_cast<std::size_t>(i - 2)] !=
                                    points.value[static_cast<std::size_t>(i - 1)]);
    if (!jump) x += std::pow(10.0, -3 + 2 * unit(random)) / count;
    double extinction = unit(random) < 0.3 ? 0 : std::pow(10.0, -3 + 3 * unit(random));
    if (i == count / 2) extinction = 1e6;
    points.value.push_back(static_cast<T>(x));
    points.material.push_back({static_cast<T>(extinction), {draw(), draw(), T(0.5)}});
    // Two values that have rounded to one are a jump; three would not be allowed.
    const std::size_t n = points.value.size();
    if (n > 2 && points.value[n - 1] == points.value[n - 3]) {
      points.value.pop_back();
      points.material.pop_back();
    }
  }
  return points;
}

/// The material in an interval, in long double, from the two points alone.
template <class T>
struct WideMaterial {
  Real extinction, color[3];
  WideMaterial(const PiecewiseLinear<T>& table, int i, Real v) {
    const Material<T>&a = table.material[std::max(i - 1, 0)],
          &b = table.material[std::min(i, table.count - 1)];
    const bool outside = i == 0 || i == table.count;
    const Real s = outside ? 0
                           : (v - Real(table.value[i - 1])) /
                                 (Real(table.value[i]) - Real(table.value[i - 1]));
    const auto between = [&](T p, T q) { return (1 - s) * Real(p) + s * Real(q); };
    extinction = between(a.extinction, b.extinction);
    color[0] = between(a.color.r, b.color.r);
    color[1] = between(a.color.g, b.color.g);
    color[2] = between(a.color.b, b.color.b);
  }
};

/// By Simpson's rule, exact for the quadratics that these are, over every interval that the range
/// meets.
struct WideSummary {
  Real mass = 0, emission[3] = {0, 0, 0}, variation = 0, color_variation = 0;
  Real slope_min = 1e300L, slope_max = -1e300L, color_slope = 0, largest_extinction = 0;
  Real color_min[3] = {1e300L, 1e300L, 1e300L}, color_max[3] = {-1e300L, -1e300L, -1e300L};
  Real support_min = 1e300L, support_max = -1e300L;
  bool jump = false;
};
template <class T>
WideSummary wide_summary(const PiecewiseLinear<T>& table, T lower, T upper) {
  WideSummary s;
  for (int i = 0; i <= table.count; ++i) {
    const Real begin = i == 0 ? Real(lower) : std::max(Real(lower), Real(table.value[i - 1]));
    const Real end = i == table.count ? Real(upper) : std::min(Real(upper), Real(table.value[i]));
    if (i > 0 && i < table.count && table.value[i] == table.value[i - 1]) {
      if (table.value[i] <= lower || table.value[i] >= upper) continue;
      const Material<T>&a = table.material[i - 1], &b = table.material[i];
      s.jump = s.jump || a.extinction != b.extinction;
      s.variation += std::fabs(Real(b.extinction) - Real(a.extinction));
      const Real change = std::max(std::fabs(Real(b.color.r) - Real(a.color.r)),
                                   std::fabs(Real(b.color.g) - Real(a.color.g)));
      s.color_variation += Real(std::min(a.extinction, b.extinction)) * change;
      continue;
    }
    if (!(end > begin)) continue;
    const WideMaterial<T> a(table, i, begin), m(table, i, (begin + end) / 2), b(table, i, end);
    s.mass += (end - begin) / 6 * (a.extinction + 4 * m.extinction + b.extinction);
    Real change = 0;
    for (int c = 0; c < 3; ++c) {
      s.emission[c] +=
          (end - begin) / 6 *
          (a.extinction * a.color[c] + 4 * m.extinction * m.color[c] + b.extinction * b.color[c]);
      change = std::max(change, std::fabs(b.color[c] - a.color[c]));
    }
    const Real slope = (b.extinction - a.extinction) / (end - begin);
    s.slope_min = std::min(s.slope_min, slope);
    s.slope_max = std::max(s.slope_max, slope);
    s.variation += std::fabs(b.extinction - a.extinction);
    if (a.extinction <= 0 && b.extinction <= 0) continue;
    s.color_variation += change * m.extinction;
    s.color_slope =
        std::max(s.color_slope, change / (end - begin) * std::max(a.extinction, b.extinction));
    s.largest_extinction = std::max({s.largest_extinction, a.extinction, b.extinction});
    s.support_min = std::min(s.support_min, begin);
    s.support_max = std::max(s.support_max, end);
    for (int c = 0; c < 3; ++c) {
      s.color_min[c] = std::min({s.color_min[c], a.color[c], b.color[c]});
      s.color_max[c] = std::max({s.color_max[c], a.color[c], b.color[c]});
    }
  }
  return s;
}

/// The sums to the error that the antiderivative states, however small the range is beside the
/// peak; the bounds no tighter than the truth and no looser, but for rounding.
TYPED_TEST(Antiderivative, RangesAgreeWithTheTruth) {
  using T = TypeParam;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  ErrorRecord mass("mass, of the stated error", ""), emission("emission, of the stated error", ""),
      variation("variation", "u"), color_variation("color variation", "u"), slopes("slopes", "u");
  for (int trial = 0; trial < 400; ++trial) {
    const int count = trial < 300 ? 1 + trial % 40 : 4096;
    const Points<T> points = random_points<T>(random, count);
    const PiecewiseLinear<T> table = points.view();
    const AntiderivativeStorage<T> storage(table);
    const PiecewiseLinearAntiderivative<T> view = storage.view();
    ASSERT_EQ(view.leaves, table.count - 1);
    EXPECT_LE(view.rounding, 60 * rounding_unit<T>);
    const T span = points.value.back() - points.value.front();
    for (int i = 0; i < 30; ++i) {
      const auto any_value = [&] {
        const std::size_t k = static_cast<std::size_t>(unit(random) * table.count);
        if (unit(random) < 0.3) return points.value[k];
        return static_cast<T>(points.value.front() + span * T(1.4 * unit(random) - 0.2));
      };
      T a = any_value(), b = any_value();
      if (i % 3 == 0) b = a + span * static_cast<T>(std::pow(10.0, -1 - 3 * unit(random)));
      if (a == b) continue;
      if (a > b) std::swap(a, b);
      const ValueRange<T> range(table, a, b);
      const RangeSummary<T> s = range_summary(table, view, range);
      const RangeIntegrals<T> sums = range_integrals(table, view, range);
      const WideSummary truth = wide_summary(table, a, b);
      const auto where = [&] { return "trial " + std::to_string(trial); };
      const auto share = [&](T computed, Real wide, Real size) {
        return wide == 0 && computed == 0
                   ? 0
                   : std::fabs(Real(computed) - wide) / (Real(view.rounding) * size);
      };
      for (const RangeIntegrals<T>& sum : {s.integral, sums}) {
        mass.add(share(sum.mass, truth.mass, truth.mass), where);
        emission.add(share(sum.emission.r, truth.emission[0], truth.mass), where);
        emission.add(share(sum.emission.g, truth.emission[1], truth.mass), where);
        emission.add(share(sum.emission.b, truth.emission[2], truth.mass), where);
      }
      // Rounding of a difference of extinctions is relative to these, not to their difference.
      const Real unit_in_last = Real(rounding_unit<T>);
      variation.add(std::fabs(Real(s.variation) - truth.variation) /
                        (unit_in_last * (truth.variation + truth.largest_extinction + 1e-30L)),
                    where);
      if (truth.jump) {
        EXPECT_EQ(s.slope_max, s.infinity);
        EXPECT_EQ(s.slope_min, -s.infinity);
      } else if (truth.slope_max > -1e299L) {
        const Real size = std::max(std::fabs(truth.slope_min), std::fabs(truth.slope_max));
        if (size > 0 && s.slope_max < s.infinity) {
          slopes.add(
              std::max(truth.slope_max - Real(s.slope_max), Real(s.slope_min) - truth.slope_min) /
                  (unit_in_last * size),
              where);
        }
      }
      color_variation.add(
          std::fabs(Real(s.color_variation) - truth.color_variation) /
              (unit_in_last * (truth.color_variation + truth.largest_extinction + 1e-30L)),
          where);
      EXPECT_GE(Real(s.color_slope) * (1 + 8 * unit_in_last), truth.color_slope);
      EXPECT_EQ(s.absorbs(), truth.support_min <= truth.support_max);
      if (s.absorbs()) {
        EXPECT_EQ(Real(s.support_min), truth.support_min);
        EXPECT_EQ(Real(s.support_max), truth.support_max);
        const Real slack = 8 * unit_in_last;
        EXPECT_NEAR(double(s.color_min.r), double(truth.color_min[0]), double(slack));
        EXPECT_NEAR(double(s.color_max.g), double(truth.color_max[1]), double(slack));
        EXPECT_EQ(s.color_min.b, T(0.5));
        EXPECT_EQ(s.color_max.b, T(0.5));
        const Real range_of_colors = std::max(truth.color_max[0] - truth.color_min[0],
                                              truth.color_max[1] - truth.color_min[1]);
        EXPECT_NEAR(double(s.color_range()), double(range_of_colors), double(2 * slack));
      } else {
        EXPECT_EQ(s.color_range(), T(0));
        EXPECT_EQ(s.integral.mass, T(0));
      }
    }
  }
  for (const ErrorRecord* record : {&mass, &emission, &variation, &color_variation, &slopes})
    record->print();
  EXPECT_LE(mass.largest(), 1);
  EXPECT_LE(emission.largest(), 1);
  EXPECT_LE(variation.largest(), 40);
  EXPECT_LE(color_variation.largest(), 40);
  EXPECT_LE(slopes.largest(), 8);
}

TYPED_TEST(Antiderivative, AnyRunOfIntervalsIsTiledByFewNodes) {
  using T = TypeParam;
  for (const int count : {2, 3, 4, 7, 8, 12, 33, 100, 256}) {
    Points<T> points;
    for (int i = 0; i < count; ++i) {
      points.value.push_back(static_cast<T>(i));
      points.material.push_back({static_cast<T>(i), {T(1), T(1), T(1)}});
    }
    const AntiderivativeStorage<T> storage(points.view());
    int levels = 1;
    while ((1 << levels) < count) ++levels;
    for (int first = 1; first < count; ++first) {
      for (int last = first; last <= count; ++last) {
        T mass = T(0);
        int nodes = 0;
        storage.view().for_each_node(first, last, [&](const RangeSummary<T>& node) {
          mass += node.integral.mass;
          ++nodes;
        });
        // The extinction is the value: the integral from first - 1 to last - 1.
        const double a = first - 1, b = last - 1;
        ASSERT_EQ(double(mass), (b * b - a * a) / 2) << count << " " << first << " " << last;
        ASSERT_LE(nodes, 2 * levels);
      }
    }
  }
}

TYPED_TEST(Antiderivative, IntervalsAreFoundFromAnywhere) {
  using T = TypeParam;
  std::mt19937_64 random(2);
  for (const int count : {1, 2, 5, 30, 200}) {
    const Points<T> points = random_points<T>(random, count);
    const PiecewiseLinear<T> table = points.view();
    std::vector<T> values = points.value;
    for (const T x : points.value) {
      values.push_back(std::nextafter(x, T(-10)));
      values.push_back(std::nextafter(x, T(10)));
    }
    for (const T v : values) {
      const int right = table.interval(v);
      int below = 0;
      while (below < table.count && table.value[below] < v) ++below;
      for (int guess = 0; guess <= table.count; guess += 1 + guess / 8) {
        ASSERT_EQ(interval_near(table, v, guess), right);
        ASSERT_EQ(interval_below(table, v, guess), std::max(below, guess));
      }
    }
  }
}

TYPED_TEST(Antiderivative, OnePointIsTheSameEverywhere) {
  using T = TypeParam;
  const T value[] = {T(2)};
  const Material<T> material[] = {{T(3), {T(1), T(0.5), T(0)}}};
  const PiecewiseLinear<T> table{value, material, 1};
  const AntiderivativeStorage<T> storage(table);
  const RangeSummary<T> s = range_summary(table, storage.view(), ValueRange<T>(table, T(-1), T(4)));
  EXPECT_EQ(s.integral.mass, T(15));
  EXPECT_EQ(s.integral.emission.g, T(7.5));
  EXPECT_EQ(s.variation, T(0));
  EXPECT_EQ(s.slope_min, T(0));
  EXPECT_EQ(s.slope_max, T(0));
  EXPECT_EQ(s.color_range(), T(0));
  EXPECT_EQ(s.support_min, T(-1));
  EXPECT_EQ(s.support_max, T(4));
}

TYPED_TEST(Antiderivative, ColorsOfWhatIsClearDoNotCount) {
  using T = TypeParam;
  const T value[] = {T(0), T(1), T(2), T(3), T(4)};
  const Material<T> material[] = {{T(0), {T(9), T(9), T(9)}},
                                  {T(0), {T(0.25), T(0), T(0)}},
                                  {T(5), {T(0.5), T(0), T(0)}},
                                  {T(0), {T(0.75), T(0), T(0)}},
                                  {T(0), {T(-9), T(7), T(7)}}};
  const PiecewiseLinear<T> table{value, material, 5};
  const AntiderivativeStorage<T> storage(table);
  const RangeSummary<T> s = range_summary(table, storage.view(), ValueRange<T>(table, T(-1), T(5)));
  EXPECT_EQ(s.color_range(), T(0.5));
  EXPECT_EQ(s.support_min, T(1));
  EXPECT_EQ(s.support_max, T(3));
  EXPECT_FALSE(range_summary(table, storage.view(), ValueRange<T>(table, T(3), T(9))).absorbs());
}

}  // namespace
}  // namespace pellucid::test_antiderivative
