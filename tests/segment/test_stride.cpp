// SPDX-License-Identifier: Apache-2.0
#include "pellucid/segment/stride.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/segment/random_cells.h"
#include "tests/segment/wide_cubic_segment.h"
#include "tests/support/accuracy.h"

namespace pellucid::test_stride {
namespace {

/// Data that bend at places of their own: linear between knots at equal distances, the middle of
/// the stretch among them.
struct BentData {
  std::vector<float> knot;  // an odd number

  BentData(std::mt19937_64& random, float bend) {
    std::uniform_real_distribution<float> unit(0, 1);
    const int halves = std::uniform_int_distribution<int>(1, 4)(random);
    const float a = unit(random), b = a + 0.3f * (unit(random) - 0.5f), c = unit(random) - 0.5f;
    for (int i = 0; i <= 2 * halves; ++i) {
      const float t = static_cast<float>(i) / static_cast<float>(2 * halves);
      knot.push_back(a + (b - a) * t + bend * (c * 4 * t * (1 - t) + 0.3f * (unit(random) - 0.5f)));
    }
  }
  std::size_t middle() const { return knot.size() / 2; }
  /// The largest distance from the chords of the two halves: at a knot.
  double deviation() const {
    double largest = 0;
    for (const std::size_t from : {std::size_t{0}, middle()}) {
      const double a = static_cast<double>(knot[from]),
                   b = static_cast<double>(knot[from + middle()]);
      double sum = 0;  // of |data - chord|, which vanishes at both ends: the trapezoidal rule
      for (std::size_t i = 0; i <= middle(); ++i) {
        const double t = static_cast<double>(i) / static_cast<double>(middle());
        const double off = std::fabs(static_cast<double>(knot[from + i]) - (a + t * (b - a)));
        largest = std::max(largest, off);
        sum += off;
      }
      largest = std::max(largest, 2 * sum / static_cast<double>(middle()));
    }
    return largest;
  }
  /// Composed of linear pieces, each by quadrature.
  test::WideCubicSegment truth(double length, const PiecewiseLinear<double>& table) const {
    test::WideCubicSegment sum;
    const double piece = length / static_cast<double>(knot.size() - 1);
    for (std::size_t i = 0; i + 1 < knot.size(); ++i) {
      const double a = static_cast<double>(knot[i]), b = static_cast<double>(knot[i + 1]);
      const CubicBernstein<double> line{{a, a + (b - a) / 3, b - (b - a) / 3, b}};
      const test::WideCubicSegment s = test::wide_cubic_segment(line, piece, table);
      const long double transparency = 1 - sum.opacity;
      for (int c = 0; c < 3; ++c) sum.radiance[c] += transparency * s.radiance[c];
      sum.opacity += transparency * s.opacity;
      sum.depth += s.depth;
    }
    return sum;
  }
};

struct Counts {
  long taken = 0, refused = 0, proved = 0, over = 0;
  long double largest = 0;
};

Counts check(Grade grade, long count, bool jumps) {
  std::mt19937_64 random(21);
  Counts counts;
  test::ErrorRecord ratio(
      grade == Grade::proved ? "stride, error / proved bound" : "stride, error / estimate", "");
  for (long i = 0; i < count; ++i) {
    const test::RandomTable made(random, jumps);
    const auto view = made.as<double>();
    const PiecewiseLinear<double> table = view.table();
    const AntiderivativeStorage<double> storage(table);
    const BentData data(random, static_cast<float>(test::log_uniform(random, 1e-4, 0.3)));
    const double length = test::log_uniform(random, 1e-2, 10);
    const double tolerance = test::log_uniform(random, 1e-6, 1);
    const Stride<double> stride{static_cast<double>(data.knot.front()),
                                static_cast<double>(data.knot[data.middle()]),
                                static_cast<double>(data.knot.back()), length, data.deviation()};
    BoundedSegment<double> s;
    if (!integrate_stride(
            stride, table, storage.view(), 1.0, grade,
            [&](double opacity) { return tolerance * opacity; }, s)) {
      ++counts.refused;
      continue;
    }
    ++counts.taken;
    EXPECT_LE(s.color_error + s.opacity_error, tolerance * s.segment.opacity * (1 + 1e-12));
    const test::WideCubicSegment truth = data.truth(length, table);
    long double found = std::fabs(static_cast<long double>(s.segment.opacity) - truth.opacity);
    const double radiance[3] = {s.segment.radiance.r, s.segment.radiance.g, s.segment.radiance.b};
    for (int c = 0; c < 3; ++c) {
      found = std::max(found, std::fabs(static_cast<long double>(radiance[c]) - truth.radiance[c]));
    }
    const long double said = static_cast<long double>(s.color_error + s.opacity_error) + 1e-13L;
    if (s.proved) {
      ++counts.proved;
      EXPECT_LE(found, said) << i;
    }
    ratio.add(found / said, "stride " + std::to_string(i));
    if (found > said) ++counts.over;
  }
  ratio.print();
  counts.largest = ratio.largest();
  return counts;
}

TEST(Stride, ProvedBoundsHold) {
  const Counts counts = check(Grade::proved, test::span_count(4000), true);
  EXPECT_EQ(counts.over, 0);
  EXPECT_EQ(counts.proved, counts.taken);
  EXPECT_GT(counts.taken, counts.refused / 20);
  EXPECT_GT(counts.largest, 0.3L);  // not so far off as to be of no use
}

/// Each of them may be wrong, by no more than the guard, and few are.
TEST(Stride, EstimatesAreSeldomExceededAndNeverByMoreThanTheGuard) {
  const Counts proved = check(Grade::proved, test::span_count(4000), false);
  const Counts counts = check(Grade::estimated, test::span_count(4000), false);
  EXPECT_GT(counts.taken, proved.taken);
  EXPECT_LE(counts.over, counts.taken / 20);
  // The proved bound is at most stride_guard times the estimate, and what Richardson takes off is
  // at most the estimate.
  EXPECT_LE(counts.largest, stride_guard<double> + 1);
}

TEST(Stride, WhatCannotBeSeenIsNothing) {
  const float value[] = {0.5f, 0.6f, 0.7f};
  const Material<double> material[] = {{0, {1, 1, 1}}, {5, {1, 0, 0}}, {0, {1, 1, 1}}};
  const double values[] = {static_cast<double>(value[0]), static_cast<double>(value[1]),
                           static_cast<double>(value[2])};
  const PiecewiseLinear<double> table{values, material, 3};
  const AntiderivativeStorage<double> storage(table);
  BoundedSegment<double> s;
  const auto nothing = [](double) { return 0.0; };
  EXPECT_TRUE(integrate_stride(Stride<double>{0.1, 0.2, 0.15, 3, 0.1}, table, storage.view(), 1.0,
                               Grade::proved, nothing, s));
  EXPECT_EQ(s.segment.opacity, 0);
  // Vacuum at an end is not clear air.
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Stride<double>& stride :
       {Stride<double>{nan, 0.1, 0.1, 3, 0.1}, Stride<double>{0.1, nan, 0.1, 3, 0.1},
        Stride<double>{0.1, 0.1, nan, 3, 0.1}}) {
    EXPECT_FALSE(integrate_stride(
        stride, table, storage.view(), 1.0, Grade::estimated, [](double) { return 1.0; }, s));
  }
  // A peak between three points that do not see it.
  EXPECT_FALSE(integrate_stride(
      Stride<double>{0.45, 0.45, 0.45, 3, 0.2}, table, storage.view(), 1.0, Grade::estimated,
      [](double) { return 1e-3; }, s));
}

}  // namespace
}  // namespace pellucid::test_stride
