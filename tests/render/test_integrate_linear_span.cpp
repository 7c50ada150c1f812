// SPDX-License-Identifier: Apache-2.0
#include "pellucid/render/integrate_linear_span.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "tests/segment/wide_linear.h"

/// Stretches of linear data against quadrature at 50 digits between control points: what is found
/// is as near to it as is reported, in float and in double, also where ends are not where they are
/// thought to be.
namespace pellucid::test::test_integrate_linear_span {
namespace {

template <class T>
struct Table {
  std::vector<T> value;
  std::vector<Material<T>> material;

  PiecewiseLinear<T> view() const {
    return {value.data(), material.data(), static_cast<int>(value.size())};
  }
};

struct Transfer {
  Table<double> wide;
  Table<float> single;

  void add(double value, double extinction, Rgb<double> color) {
    wide.value.push_back(value);
    wide.material.push_back({extinction, color});
    single.value.push_back(static_cast<float>(value));
    single.material.push_back(
        {static_cast<float>(extinction),
         {static_cast<float>(color.r), static_cast<float>(color.g), static_cast<float>(color.b)}});
  }
  TransferTables tables() const {
    TransferTables all;
    all.wide = wide.view();
    all.single = single.view();
    for (const Material<double>& m : wide.material) {
      all.largest_extinction = std::max(all.largest_extinction, m.extinction);
    }
    return all;
  }
};

/// Ramps, a narrow peak, a gap and, if asked for, a jump, over [0, 1].
Transfer ramps(bool jump, double scale = 1) {
  Transfer t;
  t.add(0.1, 0, {0.1, 0.2, 0.8});
  t.add(0.3, 0.6 * scale, {0.2, 0.7, 0.9});
  t.add(0.45, 0.2 * scale, {0.3, 0.9, 0.4});
  t.add(0.5, 9 * scale, {1, 0.8, 0.2});
  if (jump) {
    t.add(0.5, 1 * scale, {0.1, 0.8, 0.2});
  }
  t.add(0.55, 0, {0.9, 0.3, 0.3});
  t.add(0.6, 0, {0.9, 0.3, 0.3});
  t.add(0.8, 1.5 * scale, {0.9, 0.1, 0.5});
  t.add(0.95, 0, {0.8, 0.8, 0.8});
  return t;
}

struct Truth {
  Wide transparency = 1;
  std::array<Wide, 3> radiance{0, 0, 0};

  double opacity() const { return static_cast<double>(1 - transparency); }
  /// The largest difference in any channel of RGBA.
  template <class T>
  double off(const SegmentResult<T>& s) const {
    const auto apart = [](T found, const Wide& wanted) {
      return static_cast<double>(abs(Wide(found) - wanted));
    };
    return std::max({apart(s.opacity, 1 - transparency), apart(s.radiance.r, radiance[0]),
                     apart(s.radiance.g, radiance[1]), apart(s.radiance.b, radiance[2])});
  }
};

/// The table is cut at its control points; between them extinction and color are linear.
Truth truth_of(const Table<double>& table, double front, double back, double length) {
  const Wide f = front, b = back;
  std::vector<Wide> cuts{f, b};
  for (const double v : table.value) {
    if (v > std::min(front, back) && v < std::max(front, back)) cuts.push_back(v);
  }
  std::sort(cuts.begin(), cuts.end());
  if (back < front) std::reverse(cuts.begin(), cuts.end());
  Truth truth;
  const std::size_t last = table.value.size() - 1;
  for (std::size_t c = 0; c + 1 < cuts.size(); ++c) {
    const Wide& from = cuts[c];
    const Wide& to = cuts[c + 1];
    if (from == to && c > 0) continue;
    const Wide middle = (from + to) / 2;
    std::size_t i = 0;
    while (i <= last && table.value[i] <= middle) ++i;
    const auto at = [&](const Wide& v) {
      std::array<Wide, 4> m;
      const Material<double>& lower = table.material[i == 0 ? 0 : i - 1];
      const Material<double>& upper = table.material[std::min(i, last)];
      const bool inside = i > 0 && i <= last;
      const Wide s =
          inside ? (v - table.value[i - 1]) / (Wide(table.value[i]) - table.value[i - 1]) : Wide(0);
      m[0] = lower.extinction + s * (Wide(upper.extinction) - lower.extinction);
      m[1] = lower.color.r + s * (Wide(upper.color.r) - lower.color.r);
      m[2] = lower.color.g + s * (Wide(upper.color.g) - lower.color.g);
      m[3] = lower.color.b + s * (Wide(upper.color.b) - lower.color.b);
      return m;
    };
    const auto p = at(from), q = at(to);
    const Wide share = f == b ? Wide(1) : abs(to - from) / abs(b - f);
    // Rounded to double they are off by u, which is small against what is allowed.
    const WideLinear w = wide_linear(static_cast<double>(p[0]), static_cast<double>(q[0]),
                                     static_cast<double>(length * share));
    for (std::size_t k = 0; k < 3; ++k) {
      truth.radiance[k] += truth.transparency * (p[k + 1] * w.weight_f + q[k + 1] * w.weight_b);
    }
    truth.transparency *= w.transparency;
  }
  return truth;
}

template <class T>
CellSegment<T> forced(const LinearData& data, const TransferTables& tables) {
  CellSegment<T> found;
  EXPECT_TRUE(integrate_linear_span(
      data, tables, 1.0, true, [](double) noexcept { return 0.0; }, found));
  return found;
}

struct Case {
  double front, back, length;
};

/// Short and long, falling and rising, level, beside the table and ending on control points.
std::vector<Case> cases(unsigned seed, int count) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  const double marks[] = {0.1, 0.3, 0.45, 0.5, 0.55, 0.8, 0.95};
  std::vector<Case> all;
  for (int i = 0; i < count; ++i) {
    Case c{uniform(random), uniform(random), std::exp2(-6 + 10 * uniform(random))};
    if (i % 5 == 1) c.back = c.front + 1e-4 * (uniform(random) - 0.5);
    if (i % 5 == 2) c.back = c.front;
    if (i % 5 == 3) c.front = marks[random() % 7];
    all.push_back(c);
  }
  return all;
}

template <class T>
void expect_within_what_is_reported(bool jump, double scale, double smallest_use) {
  const Transfer transfer = ramps(jump, scale);
  const TransferTables tables = transfer.tables();
  double largest = 0, most_reported = 0;
  for (const Case& c : cases(3, 300)) {
    const CellSegment<T> found = forced<T>({c.front, c.back, 0, c.length, 0, 0}, tables);
    const Truth truth = truth_of(transfer.wide, c.front, c.back, c.length);
    const double off = found.clear ? truth.opacity() : truth.off(found.found.segment);
    ASSERT_LE(off, found.error(1.0)) << c.front << " to " << c.back << ", length " << c.length;
    ASSERT_LE(truth.opacity(), found.opacity * (1 + 1e-6));
    largest = std::max(largest, off);
    most_reported = std::max(most_reported, found.error(1.0));
  }
  std::printf("[ accuracy ] off by up to %.1e, reported up to %.1e\n", largest, most_reported);
  EXPECT_LT(most_reported, smallest_use);
}

TEST(IntegrateLinearSpan, IsAsNearAsItReportsInDouble) {
  expect_within_what_is_reported<double>(false, 1, 1e-11);
  expect_within_what_is_reported<double>(false, 1e4, 2e-7);
  expect_within_what_is_reported<double>(true, 1, 1e-10);
}
TEST(IntegrateLinearSpan, IsAsNearAsItReportsInFloat) {
  expect_within_what_is_reported<float>(false, 1, 3e-2);
  expect_within_what_is_reported<float>(true, 1, 3e-2);
}

TEST(IntegrateLinearSpan, IsClearWhereNothingAbsorbs) {
  const Transfer transfer = ramps(false);
  const TransferTables tables = transfer.tables();
  EXPECT_TRUE(forced<double>({0.0, 0.0999, 0, 9, 0, 0}, tables).clear);
  EXPECT_TRUE(forced<double>({0.551, 0.599, 0, 9, 0, 0}, tables).clear);
  EXPECT_TRUE(forced<float>({2, 0.96, 0, 9, 0, 0}, tables).clear);
  EXPECT_EQ(forced<double>({0.551, 0.599, 0, 9, 0, 0}, tables).error(1.0), 0);
  // Data that may be where something absorbs are not clear.
  EXPECT_FALSE(forced<double>({0.551, 0.599, 0.01, 9, 0, 0}, tables).clear);
}

/// Data, places and lengths that are off by what is stated stay within what is reported.
TEST(IntegrateLinearSpan, WhatIsStatedToBeOffIsCharged) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> sign(-1, 1);
  for (const bool jump : {false, true}) {
    const Transfer transfer = ramps(jump);
    const TransferTables tables = transfer.tables();
    for (const double size : {1e-3, 1e-6}) {
      for (const Case& c : cases(5, 120)) {
        const double off = size * c.length;
        const LinearData values{c.front, c.back, size, c.length, 0, 0};
        const LinearData ends{c.front, c.back, 0, c.length, 0, off};
        const double error_of_values = forced<double>(values, tables).error(1.0);
        const Truth moved = truth_of(transfer.wide, c.front + size * sign(random),
                                     c.back + size * sign(random), c.length);
        const CellSegment<double> of_values = forced<double>(values, tables);
        EXPECT_LE(of_values.clear ? moved.opacity() : moved.off(of_values.found.segment),
                  error_of_values)
            << c.front << " to " << c.back << ", length " << c.length << ", " << size;
        // An end farther out, the data as they are there.
        const CellSegment<double> of_ends = forced<double>(ends, tables);
        const double slope = (c.back - c.front) / c.length, more = off * std::fabs(sign(random));
        const Truth longer =
            truth_of(transfer.wide, c.front, c.back + slope * more, c.length + more);
        if (!of_ends.clear) {
          EXPECT_LE(longer.off(of_ends.found.segment), of_ends.error(1.0))
              << c.front << " to " << c.back << ", length " << c.length << ", " << size;
        }
      }
    }
  }
}

/// Where two stretches meet in a place that is not known well, what one has too much the other has
/// too little of: together they are as near as they report, though neither is by its end_error.
TEST(IntegrateLinearSpan, APlaceBetweenTwoStretchesIsChargedByWhatChangesThere) {
  const Transfer transfer = ramps(false);
  const TransferTables tables = transfer.tables();
  for (const Case& c : cases(6, 150)) {
    const double off = 1e-3 * c.length, at = 0.4 * c.length;
    const double slope = (c.back - c.front) / c.length;
    const double middle = c.front + slope * at;
    // The second stretch bends away; its front is thought to be farther along than it is.
    const double bent = middle + 0.5 * slope * (c.length - at);
    const LinearData first{c.front, middle, 0, at + off, off, 0};
    const LinearData second{middle, bent, 0, c.length - at - off, off, 0};
    const CellSegment<double> a = forced<double>(first, tables), b = forced<double>(second, tables);
    Truth truth = truth_of(transfer.wide, c.front, middle, at);
    const Truth rest = truth_of(transfer.wide, middle, bent, c.length - at);
    for (std::size_t k = 0; k < 3; ++k) {
      truth.radiance[k] += truth.transparency * rest.radiance[k];
    }
    truth.transparency *= rest.transparency;
    SegmentResult<double> both;
    if (!a.clear) both = compose(both, a.found.segment);
    if (!b.clear) both = compose(both, b.found.segment);
    EXPECT_LE(truth.off(both), a.error(1.0) + b.error(1.0))
        << c.front << " to " << c.back << ", length " << c.length;
  }
}

TEST(IntegrateLinearSpan, SaysWhereFloatIsNotEnough) {
  const Transfer transfer = ramps(false);
  TransferTables tables = transfer.tables();
  const LinearData data{0.2, 0.5, 0, 2, 0, 0};
  CellSegment<float> found;
  EXPECT_FALSE(integrate_linear_span(
      data, tables, 1.0, false, [](double) noexcept { return 1e-7; }, found));
  EXPECT_TRUE(integrate_linear_span(
      data, tables, 1.0, false, [](double) noexcept { return 1e-1; }, found));
  // Control points that are one in float: anything may be there.
  const double merged[] = {0.3};
  tables.merged = merged;
  tables.merged_count = 1;
  EXPECT_FALSE(integrate_linear_span(
      data, tables, 1.0, false, [](double) noexcept { return 1e-1; }, found));
  EXPECT_GE(forced<float>(data, tables).error(1.0), 1.0);
  EXPECT_LT(forced<double>(data, tables).error(1.0), 1e-12);
}

}  // namespace
}  // namespace pellucid::test::test_integrate_linear_span
