// SPDX-License-Identifier: Apache-2.0
#include "pellucid/segment/cubic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "pellucid/segment/piecewise_linear.h"
#include "tests/segment/table_rows.h"
#include "tests/segment/wide_cubic_segment.h"

namespace pellucid::test_cubic {
namespace {

using test::ErrorRecord;
using test::OwnedTable;
using test::Table;

template <class T>
class Cubic : public testing::Test {};
using NumberTypes = testing::Types<float, double>;
TYPED_TEST_SUITE(Cubic, NumberTypes);

/// Equation (16) in the number type under test, from the table's corners and ends.
template <class T>
CubicBernstein<T> data_of(const Table& table, std::size_t row) {
  const std::vector<double> v = table.list(row, "corners"), p = table.list(row, "entry"),
                            q = table.list(row, "exit");
  const auto lerp = [](T a, T b, double t) { return a + static_cast<T>(t) * (b - a); };
  const auto at = [&](double x, double y, double z) {
    const auto c = [&](std::size_t i) { return static_cast<T>(v[i]); };
    return lerp(lerp(lerp(c(0), c(1), x), lerp(c(2), c(3), x), y),
                lerp(lerp(c(4), c(5), x), lerp(c(6), c(7), x), y), z);
  };
  const auto mean = [](T a, T b, T c) { return a + ((b - a) + (c - a)) * (T(1) / T(3)); };
  return {{at(p[0], p[1], p[2]),
           mean(at(q[0], p[1], p[2]), at(p[0], q[1], p[2]), at(p[0], p[1], q[2])),
           mean(at(p[0], q[1], q[2]), at(q[0], p[1], q[2]), at(q[0], q[1], p[2])),
           at(q[0], q[1], q[2])}};
}

/// The conformance requirement of section 6: every cell within the tolerance, absolute.
template <class T>
void expect_table_within(T tolerance) {
  const Table table = Table::reference("trilinear_cell.csv");
  char name[64];
  std::snprintf(name, sizeof name, "%s %.0e ", test::number_name<T>(), double(tolerance));
  ErrorRecord opacity(std::string(name) + "opacity", "absolute"),
      radiance(std::string(name) + "radiance", "absolute"),
      depth(std::string(name) + "depth", "relative");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (table.text(row, "tf_kind") != "piecewise_linear") continue;
    const OwnedTable<T> transfer = test::transfer_function_of<T>(table, row);
    const T length = static_cast<T>(table.number(row, "D"));
    const CubicBernstein<T> data = data_of<T>(table, row);
    const SegmentResult<T> s = integrate_cubic(data, length, transfer.view(), tolerance);
    const std::string where = test::row_name(table, row);
    const auto error = [&](T computed, const char* column) {
      return std::fabs(static_cast<long double>(computed) - table.wide(row, column));
    };
    opacity.add(error(s.opacity, "opacity"), where);
    radiance.add(error(s.radiance.r, "radiance_r"), where);
    radiance.add(error(s.radiance.g, "radiance_g"), where);
    radiance.add(error(s.radiance.b, "radiance_b"), where);
    const long double truth = table.wide(row, "optical_depth");
    depth.add(truth > 1e-6L ? error(s.optical_depth, "optical_depth") / truth : 0.0L, where);
    EXPECT_NEAR(double(optical_depth_cubic(data, length, transfer.view())), double(s.optical_depth),
                16 * double(rounding_unit<T> * s.optical_depth))
        << where;
    EXPECT_GE(s.opacity, T(0)) << where;
    EXPECT_LE(s.opacity, T(1)) << where;
  }
  opacity.print();
  radiance.print();
  depth.print();
  EXPECT_EQ(opacity.count(), 200u);
  EXPECT_LE(opacity.largest(), static_cast<long double>(tolerance));
  EXPECT_LE(radiance.largest(), static_cast<long double>(tolerance));
}

TEST(CubicTable, Float1e3) {
  expect_table_within<float>(1e-3f);
}
TEST(CubicTable, Float1e5) {
  expect_table_within<float>(1e-5f);
}
TEST(CubicTable, Float1e6) {
  expect_table_within<float>(1e-6f);
}
TEST(CubicTable, Double1e3) {
  expect_table_within<double>(1e-3);
}
TEST(CubicTable, Double1e6) {
  expect_table_within<double>(1e-6);
}
TEST(CubicTable, Double1e9) {
  expect_table_within<double>(1e-9);
}
TEST(CubicTable, Double1e10) {
  expect_table_within<double>(1e-10);
}
TEST(CubicTable, Double1e12) {
  expect_table_within<double>(1e-12);
}

template <class T>
OwnedTable<T> random_transfer(std::mt19937_64& random, bool jumps) {
  std::uniform_real_distribution<double> unit(0, 1);
  OwnedTable<T> table;
  const int points = std::uniform_int_distribution<int>(1, 9)(random);
  const double scale = std::pow(10.0, -4 + 7 * unit(random));
  if (unit(random) < 0.4) {  // one interval over all of the data: pieces are far from linear
    const bool rising = unit(random) < 0.5;
    const double least = unit(random) < 0.5 ? 0 : scale * std::pow(10.0, -3 * unit(random));
    table.add(0, rising ? least : scale, 0, 1, 1);
    table.add(1, rising ? scale : least, 1, 0, 1);
    return table;
  }
  double x = unit(random) * 0.3;
  for (int i = 0; i < points; ++i) {
    if (i > 0) {
      const bool jump = jumps && unit(random) < 0.3 &&
                        (i < 2 || table.value[static_cast<std::size_t>(i - 2)] !=
                                      table.value[static_cast<std::size_t>(i - 1)]);
      if (!jump) x += 0.02 + 0.3 * unit(random);
    }
    table.add(x, unit(random) < 0.25 ? 0 : scale * std::pow(unit(random), 3), unit(random),
              unit(random) < 0.5 ? 1 : 0, 1);
  }
  return table;
}

template <class T>
CubicBernstein<T> random_data(std::mt19937_64& random, int kind) {
  std::uniform_real_distribution<double> unit(0, 1);
  double b[4];
  for (double& x : b) x = unit(random);
  if (kind % 6 == 5) {  // Chebyshev's T3: twice from one end of [0,1] to the other and back
    b[0] = 0, b[1] = 3, b[2] = -2, b[3] = 1;
    for (double& y : b) y = 0.001 + 0.998 * y;
  } else if (kind % 5 == 1) {  // small variation: one interval, mostly
    for (double& x : b) x = b[0] + 0.01 * (x - 0.5);
  } else if (kind % 5 == 2) {  // a line
    b[1] = (2 * b[0] + b[3]) / 3;
    b[2] = (b[0] + 2 * b[3]) / 3;
  } else if (kind % 5 == 3) {  // three turns
    b[1] = 3 * unit(random) - 1;
    b[2] = 3 * unit(random) - 1;
  } else if (kind % 5 == 4) {  // vanishing slope at the ends
    b[1] = b[0];
    if (unit(random) < 0.5) b[2] = b[3];
  }
  CubicBernstein<T> f;
  for (int k = 0; k < 4; ++k) f.b[k] = static_cast<T>(b[k]);
  return f;
}

/// The contract of `tolerance`: error <= tolerance · opacity (per unit of color), on random cells
/// from clear to opaque. The rest that is allowed is rounding: of the data against the intervals'
/// width (1/50 at least) and extinctions.
template <class T>
void expect_contract(T tolerance, bool jumps, double rounding, int trials, unsigned seed) {
  std::mt19937_64 random(seed);
  char name[80];
  std::snprintf(name, sizeof name, "%s %.0e%s, share of tolerance", test::number_name<T>(),
                double(tolerance), jumps ? ", jumps" : "");
  ErrorRecord share(name, "");
  for (int i = 0; i < trials; ++i) {
    const OwnedTable<T> transfer = random_transfer<T>(random, jumps);
    const CubicBernstein<T> data = random_data<T>(random, i);
    const T length = T(1);
    const test::WideCubicSegment truth = test::wide_cubic_segment(data, length, transfer.view());
    const SegmentResult<T> s = integrate_cubic(data, length, transfer.view(), tolerance);
    const long double allowed =
        static_cast<long double>(tolerance) * truth.opacity +
        static_cast<long double>(rounding) * std::min(1.0L, 30 * truth.opacity + truth.depth);
    const auto judge = [&](T computed, long double wide) {
      const long double error = std::fabs(static_cast<long double>(computed) - wide);
      share.add(error == 0 ? 0 : error / allowed, [&] { return "trial " + std::to_string(i); });
    };
    judge(s.opacity, truth.opacity);
    judge(s.radiance.r, truth.radiance[0]);
    judge(s.radiance.g, truth.radiance[1]);
    judge(s.radiance.b, truth.radiance[2]);
    // Blue has one color throughout.
    EXPECT_NEAR(double(s.radiance.b), double(s.opacity), 64 * double(rounding_unit<T> * s.opacity));
    EXPECT_LE(s.radiance.r, s.opacity * (T(1) + 16 * rounding_unit<T>));
  }
  share.print();
  EXPECT_LE(share.largest(), 1);
}

TEST(CubicContract, Float1e3) {
  expect_contract<float>(1e-3f, false, 3e-6, 1500, 11);
}
TEST(CubicContract, Float1e5) {
  expect_contract<float>(1e-5f, false, 3e-6, 1500, 12);
}
TEST(CubicContract, Double1e3) {
  expect_contract<double>(1e-3, false, 1e-14, 1500, 13);
}
TEST(CubicContract, Double1e6) {
  expect_contract<double>(1e-6, false, 1e-14, 1500, 14);
}
TEST(CubicContract, Double1e10) {
  expect_contract<double>(1e-10, false, 1e-14, 1500, 15);
}
TEST(CubicContract, DoubleJumps1e6) {
  expect_contract<double>(1e-6, true, 1e-12, 1500, 16);
}
TEST(CubicContract, DoubleJumps1e10) {
  expect_contract<double>(1e-10, true, 1e-12, 1500, 17);
}

/// Cutting a cell anywhere and composing the parts gives the cell: what makes a pixel independent
/// of where the ray is cut.
TYPED_TEST(Cubic, PartsComposeToTheWhole) {
  using T = TypeParam;
  std::mt19937_64 random(18);
  std::uniform_real_distribution<T> unit(T(0), T(1));
  const T tolerance = is_single<T> ? T(1e-5) : T(1e-10);
  for (int i = 0; i < 500; ++i) {
    const OwnedTable<T> transfer = random_transfer<T>(random, false);
    const CubicBernstein<T> data = random_data<T>(random, i);
    const T t = unit(random);
    const SegmentResult<T> whole = integrate_cubic(data, T(0.1), transfer.view(), tolerance);
    const SegmentResult<T> parts =
        compose(integrate_cubic(restrict_to(data, T(0), t), T(0.1) * t, transfer.view(), tolerance),
                integrate_cubic(restrict_to(data, t, T(1)), T(0.1) * (T(1) - t), transfer.view(),
                                tolerance));
    const double slack = 2 * double(tolerance) + 400 * double(rounding_unit<T>);
    ASSERT_NEAR(double(parts.opacity), double(whole.opacity), slack) << i;
    ASSERT_NEAR(double(parts.radiance.r), double(whole.radiance.r), slack) << i;
    ASSERT_NEAR(double(parts.optical_depth), double(whole.optical_depth),
                1000 * double(rounding_unit<T>) * (1 + double(whole.optical_depth)))
        << i;
  }
}

/// On linear data the closed form of the other kernel.
TYPED_TEST(Cubic, LinearDataAgreeWithTheClosedForm) {
  using T = TypeParam;
  std::mt19937_64 random(19);
  std::uniform_real_distribution<T> unit(T(0), T(1));
  const T tolerance = is_single<T> ? T(1e-6) : T(1e-12);
  for (int i = 0; i < 500; ++i) {
    const OwnedTable<T> transfer = random_transfer<T>(random, false);
    const T f = T(1.5) * unit(random), b = T(1.5) * unit(random);
    const CubicBernstein<T> data{{f, f + (b - f) * (T(1) / T(3)), b - (b - f) * (T(1) / T(3)), b}};
    const SegmentResult<T> cubic = integrate_cubic(data, T(0.1), transfer.view(), tolerance);
    const SegmentResult<T> linear = piecewise_linear_segment(transfer.view(), f, b, T(0.1));
    const double slack = double(tolerance) + 600 * double(rounding_unit<T>);
    ASSERT_NEAR(double(cubic.opacity), double(linear.opacity), slack) << i;
    ASSERT_NEAR(double(cubic.radiance.r), double(linear.radiance.r), slack) << i;
  }
}

template <class T>
OwnedTable<T> window_table() {
  OwnedTable<T> table;  // absorbs between 0.4 and 0.6 only
  table.add(0.4, 0, 1, 0, 0);
  table.add(0.5, 8, 0, 1, 0);
  table.add(0.6, 0, 0, 0, 1);
  return table;
}

TYPED_TEST(Cubic, NothingIsExactlyNothing) {
  using T = TypeParam;
  const OwnedTable<T> window = window_table<T>();
  const auto expect_empty = [&](const CubicBernstein<T>& data, T length) {
    const SegmentResult<T> s = integrate_cubic(data, length, window.view(), T(1e-5));
    EXPECT_EQ(s.opacity, T(0));
    EXPECT_EQ(s.transparency, T(1));
    EXPECT_EQ(s.optical_depth, T(0));
    EXPECT_EQ(s.radiance, Rgb<T>{});
    EXPECT_EQ(optical_depth_cubic(data, length, window.view()), T(0));
  };
  expect_empty({{T(0), T(0.1), T(0.3), T(0.2)}}, T(1e6));      // below
  expect_empty({{T(0.7), T(9), T(1e5), T(0.7)}}, T(1e6));      // above
  expect_empty({{T(0.4), T(0.4), T(0.4), T(0.4)}}, T(1));      // at the window's edge
  expect_empty({{T(0.45), T(0.5), T(0.55), T(0.6)}}, T(0));    // no length
  expect_empty({{T(0.1), T(0.45), T(-0.2), T(0.1)}}, T(1e6));  // only the hull gets there
}

/// Data that touch a control value, start or end at one, or turn at one.
TYPED_TEST(Cubic, ControlValuesAtEndsAndTurns) {
  using T = TypeParam;
  const OwnedTable<T> window = window_table<T>();
  const double u = double(rounding_unit<T>);
  // Up from the edge to the peak and no further: mean extinction 4 along a line.
  const CubicBernstein<T> half{{T(0.4), T(0.4) + T(0.1) / T(3), T(0.5) - T(0.1) / T(3), T(0.5)}};
  EXPECT_NEAR(double(optical_depth_cubic(half, T(1), window.view())), 4, 64 * u);
  // A parabola from edge to edge that turns at the peak: 8 (1 - (2t-1)²), mean 16/3.
  const CubicBernstein<T> turn{{T(0.4), T(0.4) + T(0.4) / T(3), T(0.4) + T(0.4) / T(3), T(0.4)}};
  EXPECT_NEAR(double(optical_depth_cubic(turn, T(1), window.view())), 16.0 / 3, 200 * u);
  // Through the whole window on a line: twice the first.
  const CubicBernstein<T> through{{T(0.4), T(0.4) + T(0.2) / T(3), T(0.6) - T(0.2) / T(3), T(0.6)}};
  EXPECT_NEAR(double(optical_depth_cubic(through, T(2), window.view())), 8, 64 * u);
}

/// Reversing the ray keeps the depth and mirrors the colors.
TYPED_TEST(Cubic, ReversedRayHasTheSameDepth) {
  using T = TypeParam;
  std::mt19937_64 random(20);
  for (int i = 0; i < 500; ++i) {
    const OwnedTable<T> transfer = random_transfer<T>(random, false);
    const CubicBernstein<T> f = random_data<T>(random, i);
    const CubicBernstein<T> g{{f.b[3], f.b[2], f.b[1], f.b[0]}};
    const double depth = double(optical_depth_cubic(f, T(1), transfer.view()));
    ASSERT_NEAR(double(optical_depth_cubic(g, T(1), transfer.view())), depth,
                1e3 * double(rounding_unit<T>) * (depth + 1));
  }
}

/// Far beyond what the tolerance can be held to, everything stays finite, in bounds, and ends.
TYPED_TEST(Cubic, HardInputsStayFiniteAndInBounds) {
  using T = TypeParam;
  std::mt19937_64 random(21);
  std::uniform_real_distribution<double> unit(0, 1);
  const T tolerances[] = {T(1), T(1e-3), T(1e-9), T(0)};
  for (int i = 0; i < 4000; ++i) {
    OwnedTable<T> transfer;
    const double scale = std::pow(10.0, -3 + 9 * unit(random));
    double x = scale * (unit(random) - 0.5);
    for (int k = 0; k < 6; ++k) {
      transfer.add(x, std::pow(10.0, -6 + 12 * unit(random)) * (unit(random) < 0.7), unit(random),
                   unit(random), unit(random));
      if (unit(random) < 0.5) {
        x += scale * std::pow(10.0, -12 * unit(random));  // far below the resolution of x, too
      } else {
        x = double(std::nextafter(static_cast<T>(x), std::numeric_limits<T>::max()));
      }
      if (k > 0 && static_cast<T>(x) <= transfer.value.back()) {
        x = double(std::nextafter(transfer.value.back(), std::numeric_limits<T>::max()));
      }
    }
    CubicBernstein<T> data;
    for (T& b : data.b) b = static_cast<T>(scale * (unit(random) - 0.5));
    if (i % 4 == 0) data.b[0] = transfer.value[2];
    if (i % 5 == 0) data.b[3] = transfer.value[3];
    if (i % 7 == 0) data.b[1] = data.b[2] = data.b[3] = data.b[0];
    const T length = static_cast<T>(std::pow(10.0, -6 + 12 * unit(random)));
    const SegmentResult<T> s = integrate_cubic(data, length, transfer.view(), tolerances[i % 4]);
    SCOPED_TRACE(testing::Message() << "trial " << i);
    ASSERT_TRUE(std::isfinite(s.optical_depth));
    ASSERT_GE(s.optical_depth, T(0));
    ASSERT_GE(s.opacity, T(0));
    ASSERT_LE(s.opacity, T(1));
    ASSERT_GE(s.transparency, T(0));
    ASSERT_LE(s.transparency, T(1));
    for (const T c : {s.radiance.r, s.radiance.g, s.radiance.b}) {
      ASSERT_GE(c, T(0));
      ASSERT_LE(c, s.opacity * (T(1) + 16 * rounding_unit<T>));
    }
  }
}

}  // namespace
}  // namespace pellucid::test_cubic
