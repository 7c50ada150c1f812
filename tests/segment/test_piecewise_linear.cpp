// SPDX-License-Identifier: Apache-2.0
#include "pellucid/segment/piecewise_linear.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/segment/table_rows.h"
#include "tests/segment/wide_linear.h"

namespace pellucid::test_piecewise_linear {
namespace {

using test::ErrorRecord;
using test::OwnedTable;
using test::Table;

template <class T>
class PiecewiseLinearSegment : public testing::Test {};
using NumberTypes = testing::Types<float, double>;
TYPED_TEST_SUITE(PiecewiseLinearSegment, NumberTypes);

/// In units of u · opacity.
template <class T>
long double error_over_opacity(T computed, long double truth, long double opacity) {
  const long double error = test::absolute_error_in_u(computed, truth);
  return error == 0 ? 0 : error / opacity;
}

TYPED_TEST(PiecewiseLinearSegment, TruthTable) {
  using T = TypeParam;
  const Table table = Table::reference("piecewise_linear_segment.csv");
  const std::string name = test::number_name<T>();
  ErrorRecord opacity(name + " opacity", "u opacity"), radiance(name + " radiance", "u opacity"),
      depth(name + " optical depth, relative");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const OwnedTable<T> transfer = test::transfer_function_of<T>(table, row);
    const SegmentResult<T> s = piecewise_linear_segment(
        transfer.view(), static_cast<T>(table.number(row, "v_f")),
        static_cast<T>(table.number(row, "v_b")), static_cast<T>(table.number(row, "D")));
    const std::string where = test::row_name(table, row);
    const long double truth = table.wide(row, "opacity");
    opacity.add(error_over_opacity(s.opacity, truth, truth), where);
    radiance.add(error_over_opacity(s.radiance.r, table.wide(row, "radiance_r"), truth), where);
    radiance.add(error_over_opacity(s.radiance.g, table.wide(row, "radiance_g"), truth), where);
    radiance.add(error_over_opacity(s.radiance.b, table.wide(row, "radiance_b"), truth), where);
    depth.add(test::relative_error_in_u(s.optical_depth, table.wide(row, "optical_depth")), where);
    EXPECT_LE(s.opacity, T(1)) << where;
    EXPECT_GE(s.opacity, T(0)) << where;
  }
  opacity.print();
  radiance.print();
  depth.print();
  EXPECT_EQ(opacity.count(), 500u);
  EXPECT_LE(opacity.largest(), 16);
  EXPECT_LE(radiance.largest(), 16);
  EXPECT_LE(depth.largest(), 16);
}

/// A wide table (16 points) in ray order, forwards and backwards, against 60-digit linear segments
/// cut at the exact places.
TYPED_TEST(PiecewiseLinearSegment, RandomTablesBothWays) {
  using T = TypeParam;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  const std::string name = test::number_name<T>();
  ErrorRecord opacity(name + " opacity, 16 points", "u opacity"),
      radiance(name + " radiance, 16 points", "u opacity");
  for (int trial = 0; trial < 24; ++trial) {
    OwnedTable<T> transfer;
    const double scale = std::pow(10.0, -6 + 7 * unit(random));
    double x = 0;
    for (int i = 0; i < 16; ++i) {
      if (i > 0 && unit(random) > 0.2) x += std::pow(10.0, -3 * unit(random));  // else a jump
      if (i > 1 && transfer.value[static_cast<std::size_t>(i - 2)] == static_cast<T>(x))
        x += 0.25;  // no triple point
      transfer.add(x, unit(random) < 0.2 ? 0 : scale * unit(random), unit(random), 1, 0);
    }
    const T last = transfer.value.back();
    const T lo = static_cast<T>(-0.25 * double(last) * unit(random));
    const T hi = static_cast<T>(double(last) * (0.75 + 0.5 * unit(random)));
    for (const bool rising : {true, false}) {
      const T v_f = rising ? lo : hi, v_b = rising ? hi : lo;
      test::Wide depth = 0, light = 0;
      const auto add = [&](const Material<T>& f, const Material<T>& b, T from, T to) {
        const test::Wide length = abs(test::Wide(double(to)) - test::Wide(double(from))) /
                                  abs(test::Wide(double(v_b)) - test::Wide(double(v_f)));
        // wide_linear takes doubles: the length goes into the rates, exactly enough.
        const double d = static_cast<double>(length);
        const test::WideLinear w = test::wide_linear(double(f.extinction), double(b.extinction), d);
        light += exp(-depth) * (w.weight_f * double(f.color.r) + w.weight_b * double(b.color.r));
        depth += w.depth;
      };
      const PiecewiseLinear<T> view = transfer.view();
      std::vector<T> cuts = {v_f};
      for (int i = 0; i < 16; ++i) {
        const T c = transfer.value[static_cast<std::size_t>(rising ? i : 15 - i)];
        if (c > lo && c < hi && c != cuts.back()) cuts.push_back(c);
      }
      cuts.push_back(v_b);
      for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
        const int interval = view.interval((cuts[k] + cuts[k + 1]) / 2);
        add(view.evaluate_in(interval, cuts[k]), view.evaluate_in(interval, cuts[k + 1]), cuts[k],
            cuts[k + 1]);
      }
      const test::Wide truth = depth < 1 ? test::Wide(depth * test::wide_expm1_quotient(depth))
                                         : test::Wide(1 - exp(-depth));
      const SegmentResult<T> s = piecewise_linear_segment(view, v_f, v_b, T(1));
      const long double alpha = static_cast<long double>(truth);
      opacity.add(error_over_opacity(s.opacity, alpha, alpha), std::to_string(trial));
      radiance.add(error_over_opacity(s.radiance.r, static_cast<long double>(light), alpha),
                   std::to_string(trial));
      EXPECT_NEAR(double(s.radiance.g), double(s.opacity), 64 * double(rounding_unit<T>));
      EXPECT_EQ(s.radiance.b, T(0));
    }
  }
  opacity.print();
  radiance.print();
  EXPECT_LE(opacity.largest(), 16);
  EXPECT_LE(radiance.largest(), 16);
}

template <class T>
OwnedTable<T> step_table() {
  OwnedTable<T> step;  // 1 and red below, 3 and green above a jump at 0.5
  step.add(0, 1, 1, 0, 0);
  step.add(0.5, 1, 1, 0, 0);
  step.add(0.5, 3, 0, 1, 0);
  step.add(1, 3, 0, 1, 0);
  return step;
}

TYPED_TEST(PiecewiseLinearSegment, JumpsEndOneSideAndBeginTheOther) {
  using T = TypeParam;
  const OwnedTable<T> step = step_table<T>();
  const double tolerance = 8 * double(rounding_unit<T>);
  const SegmentResult<T> rising = piecewise_linear_segment(step.view(), T(0), T(1), T(2));
  EXPECT_NEAR(double(rising.optical_depth), 4, 4 * tolerance);
  EXPECT_NEAR(double(rising.radiance.r), -std::expm1(-1.0), tolerance);
  EXPECT_NEAR(double(rising.radiance.g), -std::exp(-1.0) * std::expm1(-3.0), tolerance);
  const SegmentResult<T> falling = piecewise_linear_segment(step.view(), T(1), T(0), T(2));
  EXPECT_NEAR(double(falling.radiance.g), -std::expm1(-3.0), tolerance);
  EXPECT_NEAR(double(falling.radiance.r), -std::exp(-3.0) * std::expm1(-1.0), tolerance);
  // Constant data at the jump take the right value; data that leave it take the side they enter.
  EXPECT_EQ(piecewise_linear_segment(step.view(), T(0.5), T(0.5), T(1)).optical_depth, T(3));
  EXPECT_EQ(piecewise_linear_segment(step.view(), T(0.5), T(0.25), T(1)).optical_depth, T(1));
  EXPECT_EQ(piecewise_linear_segment(step.view(), T(0.5), T(0.75), T(1)).optical_depth, T(3));
  EXPECT_EQ(piecewise_linear_segment(step.view(), T(0.25), T(0.5), T(1)).optical_depth, T(1));
}

TYPED_TEST(PiecewiseLinearSegment, OutsideOfTheTableIsConstant) {
  using T = TypeParam;
  const OwnedTable<T> step = step_table<T>();
  EXPECT_EQ(piecewise_linear_segment(step.view(), T(-7), T(-3), T(1)).optical_depth, T(1));
  EXPECT_EQ(piecewise_linear_segment(step.view(), T(3), T(2), T(1)).optical_depth, T(3));
  OwnedTable<T> point;  // one control point: the same everywhere
  point.add(5, 2, 1, 1, 1);
  for (const T v : {T(4), T(5), T(6)}) {
    EXPECT_EQ(piecewise_linear_segment(point.view(), v, T(5), T(1)).optical_depth, T(2));
    EXPECT_NEAR(double(piecewise_linear_segment(point.view(), v, T(11) - v, T(1)).opacity),
                -std::expm1(-2.0), 16 * double(rounding_unit<T>));
  }
}

TYPED_TEST(PiecewiseLinearSegment, NeighbouringValuesAreOneSegment) {
  using T = TypeParam;
  const OwnedTable<T> step = step_table<T>();
  for (const T v : {T(0.25), T(0.75)}) {
    const T next = std::nextafter(v, T(1));
    const SegmentResult<T> s = piecewise_linear_segment(step.view(), v, next, T(1));
    EXPECT_EQ(s.optical_depth, v < T(0.5) ? T(1) : T(3));
  }
}

}  // namespace
}  // namespace pellucid::test_piecewise_linear
