// SPDX-License-Identifier: Apache-2.0
#include "pellucid/math/cubic_roots.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/math_bernstein/wide_cubic.h"
#include "tests/support/accuracy.h"

namespace pellucid {
namespace {

template <class T>
class CubicRoots : public testing::Test {};
using NumberTypes = testing::Types<float, double>;
TYPED_TEST_SUITE(CubicRoots, NumberTypes);

/// Between the critical points the cubic may fall back by no more than rounding moves it.
template <class T>
void expect_monotone_pieces(const CubicBernstein<T>& f) {
  const CriticalPoints<T> turn = critical_points(f);
  ASSERT_GE(turn.count, 0);
  ASSERT_LE(turn.count, 2);
  long double cut[4] = {0, 0, 0, 0};
  int cuts = 1;
  for (int k = 0; k < turn.count; ++k) {
    ASSERT_GT(turn.t[k], T(0));
    ASSERT_LT(turn.t[k], T(1));
    cut[cuts++] = static_cast<long double>(turn.t[k]);
    ASSERT_GT(cut[cuts - 1], cut[cuts - 2]);
  }
  cut[cuts++] = 1;
  const long double slack = 8 * static_cast<long double>(rounding_unit<T>) *
                            static_cast<long double>(test::largest_coefficient(f));
  for (int k = 0; k + 1 < cuts; ++k) {
    const long double begin = test::wide_value(f, cut[k]), end = test::wide_value(f, cut[k + 1]);
    const long double sign = end >= begin ? 1 : -1;
    long double furthest = begin;
    for (int i = 1; i <= 100; ++i) {
      const long double x = test::wide_value(f, cut[k] + (cut[k + 1] - cut[k]) * i / 100);
      ASSERT_GE(sign * (x - furthest), -slack) << "piece " << k << " of " << cuts - 1;
      if (sign * (x - furthest) > 0) furthest = x;
    }
  }
}

TYPED_TEST(CubicRoots, CriticalPointsBoundMonotonePieces) {
  using T = TypeParam;
  std::mt19937_64 random(5);
  for (int i = 0; i < 20000; ++i) {
    const CubicBernstein<T> f = test::some_cubic<T>(random);
    SCOPED_TRACE(testing::Message() << "cubic " << i << ": " << f.b[0] << ' ' << f.b[1] << ' '
                                    << f.b[2] << ' ' << f.b[3]);
    expect_monotone_pieces(f);
    if (testing::Test::HasFatalFailure()) return;
  }
}

TYPED_TEST(CubicRoots, KnownCriticalPoints) {
  using T = TypeParam;
  // Chebyshev's T3 on [0,1]: turns at 1/4 and 3/4.
  const CriticalPoints<T> t3 = critical_points(CubicBernstein<T>{{T(-1), T(5), T(-5), T(1)}});
  ASSERT_EQ(t3.count, 2);
  EXPECT_NEAR(static_cast<double>(t3.t[0]), 0.25, 2 * double(rounding_unit<T>));
  EXPECT_NEAR(static_cast<double>(t3.t[1]), 0.75, 2 * double(rounding_unit<T>));
  // A parabola (no cubic term), turning at 1/2: 4 t (1-t) has the coefficients 0, 4/3, 4/3, 0.
  const CriticalPoints<T> parabola = critical_points(CubicBernstein<T>{{T(0), T(3), T(3), T(0)}});
  ASSERT_EQ(parabola.count, 1);
  EXPECT_EQ(parabola.t[0], T(0.5));
  // 3 t² - 2 t³ turns at the ends, t³ at 0, constants nowhere: all are monotone inside.
  EXPECT_EQ(critical_points(CubicBernstein<T>{{T(0), T(0), T(1), T(1)}}).count, 0);
  EXPECT_EQ(critical_points(CubicBernstein<T>{{T(0), T(0), T(0), T(1)}}).count, 0);
  EXPECT_EQ(critical_points(CubicBernstein<T>{{T(5), T(5), T(5), T(5)}}).count, 0);
  // d0 = -8, d1 = 184, d2 = 376: A = 0 exactly, B = 192, one root at 8/(2·192).
  const CriticalPoints<T> shifted =
      critical_points(CubicBernstein<T>{{T(1), T(-7), T(177), T(553)}});
  ASSERT_EQ(shifted.count, 1);
  EXPECT_NEAR(static_cast<double>(shifted.t[0]), 1.0 / 48, 2 * double(rounding_unit<T>));
}

TYPED_TEST(CubicRoots, HugeAndTinyDifferencesNeitherOverflowNorVanish) {
  using T = TypeParam;
  for (const T scale : {T(1e-30), T(1e-12), T(1), T(1e12), T(1e30)}) {
    const CriticalPoints<T> t3 =
        critical_points(CubicBernstein<T>{{-scale, T(5) * scale, T(-5) * scale, scale}});
    ASSERT_EQ(t3.count, 2);
    EXPECT_NEAR(static_cast<double>(t3.t[0]), 0.25, 1e-6);
    EXPECT_NEAR(static_cast<double>(t3.t[1]), 0.75, 1e-6);
  }
}

/// The root's own truth: bisection in long double. Its position may be off by what a function value
/// off by 4 u max|b_k - c| does, and by the resolution of t.
TYPED_TEST(CubicRoots, CrossingIsFoundToWorkingPrecision) {
  using T = TypeParam;
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> unit(0, 1);
  const std::string name = is_single<T> ? "float" : "double";
  test::ErrorRecord residual(name + " residual / max|b - c|");
  for (int i = 0; i < 30000; ++i) {
    const CubicBernstein<T> f = test::some_cubic<T>(random);
    const CriticalPoints<T> turn = critical_points(f);
    T cut[4] = {T(0), T(1), T(1), T(1)};
    int cuts = 1;
    for (int k = 0; k < turn.count; ++k) cut[cuts++] = turn.t[k];
    cut[cuts++] = T(1);
    for (int k = 0; k + 1 < cuts; ++k) {
      const T a = evaluate(f, cut[k]), b = evaluate(f, cut[k + 1]);
      // Control values close to an end of the piece (near-tangent) as often as in the middle.
      double s = unit(random);
      if (i % 3 == 0) s = std::pow(10.0, -7 * s);
      if (i % 3 == 1) s = 1 - std::pow(10.0, -7 * s);
      const T c = static_cast<T>(double(a) + s * (double(b) - double(a)));
      if (!((c > a && c < b) || (c < a && c > b))) continue;
      const bool rising = b > a;
      const T t = find_crossing(f, c, cut[k], cut[k + 1], rising);
      ASSERT_GE(t, cut[k]);
      ASSERT_LE(t, cut[k + 1]);
      const long double wide_c = static_cast<long double>(c);
      CubicBernstein<long double> offset;  // exact: no digit is lost far from zero
      long double size = 0;
      for (int n = 0; n < 4; ++n) {
        offset.b[n] = static_cast<long double>(f.b[n]) - wide_c;
        size = std::max(size, std::fabs(offset.b[n]));
      }
      // The nearest numbers around t bracket the root to within the residual.
      const long double at = test::wide_value(offset, static_cast<long double>(t));
      const long double u = static_cast<long double>(rounding_unit<T>);
      const long double step = 2 * u * static_cast<long double>(t);
      const long double before =
          test::wide_value(offset, std::max(0.0L, static_cast<long double>(t) - step));
      const long double after =
          test::wide_value(offset, std::min(1.0L, static_cast<long double>(t) + step));
      const bool bracketed = (before <= 0) != (after <= 0) || at == 0;
      residual.add(
          bracketed ? 0 : std::min({std::fabs(at), std::fabs(before), std::fabs(after)}) / size / u,
          [&] { return "cubic " + std::to_string(i) + " piece " + std::to_string(k); });
    }
  }
  residual.print();
  EXPECT_GT(residual.count(), 20000u);
  EXPECT_LE(residual.largest(), 4);
}

TYPED_TEST(CubicRoots, EndsOfTheBracketAreCrossingsToo) {
  using T = TypeParam;
  const CubicBernstein<T> line{{T(0), T(1), T(2), T(3)}};
  EXPECT_EQ(find_crossing(line, T(0), T(0), T(1), true), T(0));
  EXPECT_EQ(find_crossing(line, T(3), T(0), T(1), true), T(1));
  EXPECT_EQ(find_crossing(line, T(1.5), T(0), T(1), true), T(0.5));
  const CubicBernstein<T> falling{{T(3), T(2), T(1), T(0)}};
  EXPECT_EQ(find_crossing(falling, T(3), T(0), T(1), false), T(0));
  EXPECT_EQ(find_crossing(falling, T(0), T(0), T(1), false), T(1));
  EXPECT_EQ(find_crossing(falling, T(1.5), T(0), T(1), false), T(0.5));
}

/// (2t-1)³: the slope vanishes at the root, where Newton's method alone crawls.
TYPED_TEST(CubicRoots, TripleRootIsFound) {
  using T = TypeParam;
  const CubicBernstein<T> f{{T(-1), T(1), T(-1), T(1)}};
  const T t = find_crossing(f, T(0), T(0), T(1), true);
  // The cube root of u: no evaluation in T sees less.
  EXPECT_NEAR(static_cast<double>(t), 0.5, 2 * std::cbrt(double(rounding_unit<T>)));
}

}  // namespace
}  // namespace pellucid
