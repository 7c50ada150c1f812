// SPDX-License-Identifier: Apache-2.0
#include "pellucid/segment/table_mass.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "pellucid/segment/rounding.h"
#include "tests/segment/multivariate_case.h"
#include "tests/support/accuracy.h"

namespace pellucid::test_table_mass {
namespace {

using test::ErrorRecord;

/// A table of control points value, extinction, red.
struct Points {
  std::vector<double> value;
  std::vector<Material<double>> material;
  Points(std::initializer_list<std::array<double, 3>> points) {
    for (const auto& [v, extinction, red] : points) {
      value.push_back(v);
      material.push_back({extinction, {red, 1 - red, 0.5}});
    }
  }
  PiecewiseLinear<double> view() const {
    return {value.data(), material.data(), static_cast<int>(value.size())};
  }
};

/// The truth: depth, and ∫ extinction · color.
test::WideStretch truth_of(const CubicBernstein<double>& data, const PiecewiseLinear<double>& table,
                           double length) {
  const ChannelTable<double> one{0, table};
  MultivariateTransfer<double> transfer;
  transfer.table = &one;
  transfer.tables = 1;
  MultivariateSpan<double> span;
  span.data[0] = data;
  span.length = length;
  return test::wide_multivariate(transfer, span);
}

TEST(TableMass, DepthAndMeanColorOfRandomTables) {
  std::mt19937_64 random(100);
  ErrorRecord depth("depth, share of its rounding", ""), color("mean color", "absolute");
  long dense = 0;
  for (long i = 0; i < test::span_count(8000); ++i) {
    const auto made = test::RandomTable(random).as<double>();
    const PiecewiseLinear<double> table = made.table();
    const auto data = test::as<double>(test::random_cubic(random));
    const double length = test::log_uniform(random, 1e-3, 30);
    const TableMass<double> mass = table_mass(data, table, length);
    const test::WideStretch truth = truth_of(data, table, length);
    const double error = data_rounding(data);
    const int first = table.interval(data.hull_min() - error),
              last = table.interval(data.hull_max() + error);
    const auto rounding =
        static_cast<long double>(rounding_error(data, length, 1.0, table, first, last, error,
                                                sensitivity(table, first, last, error))
                                     .depth);
    const long double allowed = rounding + 32 * test::unit_of<double> * truth.depth + 1e-17L;
    const std::string where = "span " + std::to_string(i);
    depth.add(std::fabs(static_cast<long double>(mass.depth) - truth.depth) / allowed, where);
    if (truth.depth > 1e-3L) {
      ++dense;
      const double found[3] = {mass.color.r, mass.color.g, mass.color.b};
      for (int c = 0; c < 3; ++c) {
        color.add(std::fabs(static_cast<long double>(found[c]) - truth.emission[c] / truth.depth) /
                      (1 + 1e12L * rounding / truth.depth),
                  where);
      }
    }
  }
  depth.print();
  color.print();
  EXPECT_GT(dense, 1000);
  EXPECT_LE(depth.largest(), 1);
  EXPECT_LE(color.largest(), 1e-12L);
}

TEST(TableMass, RangesHoldEverythingThatIsSeen) {
  std::mt19937_64 random(101);
  long smooth = 0, tight = 0, seen = 0;
  for (long i = 0; i < test::span_count(20000); ++i) {
    const auto made = test::RandomTable(random).as<double>();
    const PiecewiseLinear<double> table = made.table();
    const auto data = test::as<double>(test::random_cubic(random));
    const TableMass<double> mass = table_mass(data, table, 1.0);
    double lower = 1e300, upper = 0;
    test::ErrorRecord outside("", "");
    for (int k = 0; k <= 200; ++k) {
      const Material<double> here = table.evaluate(evaluate(data, k / 200.0));
      lower = std::min(lower, here.extinction);
      upper = std::max(upper, here.extinction);
      // Next to a control point the data may be taken to lie on either side.
      if (!(here.extinction > 1e-9) || !(mass.depth > 0)) continue;
      const Rgb<double> c = here.color, in = mass.range.clamped(c);
      outside.add(static_cast<long double>(largest_component(c - in)), "");
      outside.add(static_cast<long double>(largest_component(in - c)), "");
    }
    ASSERT_LE(static_cast<double>(outside.largest()), 1e-9) << i;
    ASSERT_LE(mass.lower, lower * (1 + 1e-12) + 1e-9) << i;
    ASSERT_GE(mass.upper, upper * (1 - 1e-12) - 1e-9) << i;
    ASSERT_GE(mass.lower, 0) << i;
    if (upper > 0) {
      ++seen;
      tight += mass.upper <= 1.2 * upper;
    }
    smooth += mass.lower > 0;
  }
  EXPECT_GT(seen, 5000);
  EXPECT_GT(tight, seen / 2);
  EXPECT_GT(smooth, 500);
}

TEST(TableMass, ConstantDataHasOneMaterial) {
  const Points points{{0, 1, 0}, {1, 3, 1}};
  const TableMass<double> mass = table_mass({{0.25, 0.25, 0.25, 0.25}}, points.view(), 2.0);
  EXPECT_NEAR(mass.depth, 3, 1e-15);
  EXPECT_NEAR(mass.color.r, 0.25, 1e-15);
  EXPECT_NEAR(mass.lower, 1.5, 1e-15);
  EXPECT_NEAR(mass.upper, 1.5, 1e-15);
  EXPECT_LE(mass.range.oscillation(), 1e-15);
}

TEST(TableMass, BeyondTheEndsTheEndsHold) {
  const Points points{{0, 1, 0}, {1, 3, 1}};
  for (const auto& [value, extinction, red] :
       {std::array<double, 3>{-5, 1, 0}, std::array<double, 3>{7, 3, 1}}) {
    const TableMass<double> mass = table_mass({{value, value, value, value}}, points.view(), 1.0);
    EXPECT_EQ(mass.depth, extinction);
    EXPECT_EQ(mass.color.r, red);
    EXPECT_EQ(mass.lower, extinction);
    EXPECT_EQ(mass.upper, extinction);
  }
}

TEST(TableMass, AJumpCountsOnBothOfItsSides) {
  const Points points{{0.5, 0, 0}, {0.5, 4, 1}};
  const TableMass<double> mass = table_mass({{0, 1.0 / 3, 2.0 / 3, 1}}, points.view(), 2.0);
  EXPECT_NEAR(mass.depth, 4, 1e-14);
  EXPECT_EQ(mass.color.r, 1);
  EXPECT_EQ(mass.lower, 0);
  EXPECT_EQ(mass.upper, 4);
}

/// Data that turn in a peak of the table, hand-made: v = t (1 - t) reaches 1/4 at 1/2, a ramp from
/// 0 begins at 0, so that the depth is 4 ∫ t (1 - t) = 2/3 and the mean red ∫ 16 t² (1 - t)² /
/// (2/3) = 4/5.
TEST(TableMass, DataThatTurn) {
  const Points points{{0, 0, 0}, {0.25, 1, 1}};
  const TableMass<double> mass = table_mass({{0, 1.0 / 3, 1.0 / 3, 0}}, points.view(), 1.0);
  EXPECT_NEAR(mass.depth, 2.0 / 3, 1e-14);
  EXPECT_NEAR(mass.color.r, 0.8, 1e-13);
  EXPECT_NEAR(mass.upper, 1, 1e-14);
  EXPECT_EQ(mass.lower, 0);
}

TEST(TableMass, WhereNothingAbsorbsThereIsNothing) {
  const Points points{{0, 0, 0}, {0.25, 0, 1}, {0.5, 2, 1}};
  const TableMass<double> mass = table_mass({{-1, -0.5, 0.1, 0.2}}, points.view(), 1.0);
  EXPECT_EQ(mass.depth, 0);
  EXPECT_EQ(mass.upper, 0);
  EXPECT_EQ(mass.range.oscillation(), 0);
}

}  // namespace
}  // namespace pellucid::test_table_mass
