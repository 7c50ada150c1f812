// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/math_bernstein/wide_cubic.h"
#include "tests/support/accuracy.h"

namespace pellucid {
namespace {

template <class T>
class Bernstein : public testing::Test {};
using NumberTypes = testing::Types<float, double>;
TYPED_TEST_SUITE(Bernstein, NumberTypes);

TYPED_TEST(Bernstein, InterpolateMeetsItsEndsAndKeepsConstants) {
  using T = TypeParam;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<T> unit(T(0), T(1));
  for (int i = 0; i < 100000; ++i) {
    const T a = (unit(random) - T(0.5)) * static_cast<T>(std::pow(10.0, 8 * double(unit(random))));
    const T b = (unit(random) - T(0.5)) * static_cast<T>(std::pow(10.0, 8 * double(unit(random))));
    const T t = unit(random);
    ASSERT_EQ(interpolate(a, b, T(0)), a);
    ASSERT_EQ(interpolate(a, b, T(1)), b);
    ASSERT_EQ(interpolate(a, a, t), a);
    const T x = interpolate(a, b, t);
    ASSERT_LE(min(a, b), x);
    ASSERT_GE(max(a, b), x);
    const long double truth = (1 - static_cast<long double>(t)) * static_cast<long double>(a) +
                              static_cast<long double>(t) * static_cast<long double>(b);
    ASSERT_LE(test::absolute_error_in_u(x, truth),
              2 * static_cast<long double>(max(abs(a), abs(b))));
  }
}

TYPED_TEST(Bernstein, ValuesAndRestrictionsAreWithinFourUnits) {
  using T = TypeParam;
  std::mt19937_64 random(2);
  std::uniform_real_distribution<T> unit(T(0), T(1));
  const std::string name = is_single<T> ? "float" : "double";
  test::ErrorRecord value(name + " value / max|b|"), part(name + " restriction / max|b|");
  for (int i = 0; i < 50000; ++i) {
    const CubicBernstein<T> f = test::some_cubic<T>(random);
    const long double size = static_cast<long double>(test::largest_coefficient(f));
    if (size == 0) continue;
    T ta = unit(random), tb = unit(random);  // also reversed
    if (i % 7 == 0) ta = T(0);
    if (i % 11 == 0) tb = T(1);
    if (i % 13 == 0) tb = ta;
    const auto where = std::to_string(i);
    const T x = evaluate(f, ta);
    value.add(
        test::absolute_error_in_u(x, test::wide_value(f, static_cast<long double>(ta))) / size,
        where);
    ASSERT_LE(f.hull_min(), x);
    ASSERT_GE(f.hull_max(), x);

    const CubicBernstein<T> g = restrict_to(f, ta, tb);
    const long double a = static_cast<long double>(ta), b = static_cast<long double>(tb);
    const long double truth[4] = {test::wide_polar(f, a, a, a), test::wide_polar(f, a, a, b),
                                  test::wide_polar(f, a, b, b), test::wide_polar(f, b, b, b)};
    for (int k = 0; k < 4; ++k) {
      part.add(test::absolute_error_in_u(g.b[k], truth[k]) / size, where);
    }
    // Neighbours meet exactly, and nothing leaves the hull.
    ASSERT_EQ(g.b[0], x);
    ASSERT_EQ(g.b[3], evaluate(f, tb));
    ASSERT_LE(f.hull_min(), g.hull_min());
    ASSERT_GE(f.hull_max(), g.hull_max());
  }
  value.print();
  part.print();
  EXPECT_LE(value.largest(), 4);
  EXPECT_LE(part.largest(), 4);
}

TYPED_TEST(Bernstein, SlopesAreNowhereLessThanTheLeast) {
  using T = TypeParam;
  std::mt19937_64 random(3);
  int known = 0, attained = 0;
  for (int i = 0; i < 20000; ++i) {
    const CubicBernstein<T> f = test::some_cubic<T>(random);
    const auto said = static_cast<long double>(least_slope(f));
    if (!(said > 0)) continue;
    ++known;
    // Secants over a 64th, of which no one is less steep than the slope somewhere in it.
    const long double rounding = 64 * 8 * static_cast<long double>(rounding_unit<T>) *
                                 static_cast<long double>(test::largest_coefficient(f));
    long double least = INFINITY;
    for (int k = 0; k < 64; ++k) {
      const long double rise =
          test::wide_value(f, (k + 1) / 64.0L) - test::wide_value(f, k / 64.0L);
      least = std::min(least, std::fabs(64 * rise));
    }
    ASSERT_GE(least, said - rounding) << i;
    if (least <= 1.05L * said) ++attained;
  }
  EXPECT_GT(known, 2000);
  EXPECT_GT(attained, 500);
  EXPECT_LE(least_slope(CubicBernstein<T>{{T(0), T(2), T(1), T(3)}}), T(0));
}

TYPED_TEST(Bernstein, MeanIsTheIntegral) {
  using T = TypeParam;
  // 4 t³ has the coefficients 0, 0, 0, 4 and the integral 1; its mirror image likewise.
  EXPECT_EQ((CubicBernstein<T>{{T(0), T(0), T(0), T(4)}}.mean()), T(1));
  EXPECT_EQ((CubicBernstein<T>{{T(4), T(0), T(0), T(0)}}.mean()), T(1));
  EXPECT_EQ((CubicBernstein<T>{{T(7), T(7), T(7), T(7)}}.mean()), T(7));
  std::mt19937_64 random(3);
  for (int i = 0; i < 1000; ++i) {
    const CubicBernstein<T> f = test::some_cubic<T>(random);
    // Simpson's rule is exact for cubics.
    const long double simpson =
        (test::wide_value(f, 0) + 4 * test::wide_value(f, 0.5L) + test::wide_value(f, 1)) / 6;
    ASSERT_LE(test::absolute_error_in_u(f.mean(), simpson),
              4 * static_cast<long double>(test::largest_coefficient(f)));
  }
}

TYPED_TEST(Bernstein, WholeIntervalIsItself) {
  using T = TypeParam;
  std::mt19937_64 random(4);
  for (int i = 0; i < 1000; ++i) {
    const CubicBernstein<T> f = test::some_cubic<T>(random);
    const CubicBernstein<T> g = restrict_to(f, T(0), T(1)), reversed = restrict_to(f, T(1), T(0));
    for (int k = 0; k < 4; ++k) {
      ASSERT_EQ(g.b[k], f.b[k]);
      ASSERT_EQ(reversed.b[k], f.b[3 - k]);
    }
  }
}

TEST(LinearBernstein, IsTheCubicThatItIsElevatedTo) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 10000; ++i) {
    const LinearBernstein<double> f{{normal(random), normal(random)}};
    const CubicBernstein<double> g = as_cubic(f);
    EXPECT_EQ(f.hull_min(), g.hull_min());
    EXPECT_EQ(f.hull_max(), g.hull_max());
    const double size = std::max(std::fabs(f.b[0]), std::fabs(f.b[1]));
    const double ta = std::uniform_real_distribution<>(0, 1)(random),
                 tb = std::uniform_real_distribution<>(0, 1)(random);
    const LinearBernstein<double> part = restrict_to(f, ta, tb);
    EXPECT_EQ(part.b[0], evaluate(f, ta));
    EXPECT_EQ(part.b[1], evaluate(f, tb));
    const auto exact = [&](double t) {
      return static_cast<double>((1 - static_cast<long double>(t)) *
                                     static_cast<long double>(f.b[0]) +
                                 static_cast<long double>(t) * static_cast<long double>(f.b[1]));
    };
    for (const double t : {0.0, ta, tb, 1.0}) {
      ASSERT_NEAR(evaluate(f, t), exact(t), 2 * size * rounding_unit<double>);
      ASSERT_NEAR(evaluate(g, t), exact(t), 8 * size * rounding_unit<double>);
    }
  }
  const LinearBernstein<double> ends{{3, -2}};
  EXPECT_EQ(evaluate(ends, 0.0), 3);
  EXPECT_EQ(evaluate(ends, 1.0), -2);
}

}  // namespace
}  // namespace pellucid
