// SPDX-License-Identifier: Apache-2.0
#include "pellucid/math/polynomial.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace pellucid {
namespace {

TEST(Polynomial, HornerRunsFromTheConstantUp) {
  constexpr double c[] = {1, 10, 100, 1000};
  EXPECT_EQ(horner<double>(c, 0.0), 1);
  EXPECT_EQ(horner<double>(c, 1.0), 1111);
  EXPECT_EQ(horner<double>(c, 2.0), 1 + 20 + 400 + 8000);
  constexpr float constant[] = {7};
  EXPECT_EQ(horner<float>(constant, 3.0f), 7.0f);
}

/// On interval i the polynomial is 100 i + s, so that value and argument of the look-up can be read
/// off separately.
template <class T>
void looks_up_interval_and_position() {
  constexpr T c[4][2] = {{0, 1}, {100, 1}, {200, 1}, {300, 1}};
  EXPECT_EQ(interval_polynomial<T>(c, T(0)), T(-1));
  EXPECT_EQ(interval_polynomial<T>(c, T(0.125)), T(0));
  EXPECT_EQ(interval_polynomial<T>(c, T(0.25)), T(99));
  EXPECT_EQ(interval_polynomial<T>(c, T(0.5)), T(199));
  EXPECT_EQ(interval_polynomial<T>(c, T(0.625)), T(200));
  EXPECT_EQ(interval_polynomial<T>(c, T(1)), T(301));
  const T below = interval_polynomial<T>(c, std::nextafter(T(0.25), T(0)));
  EXPECT_LE(below, T(1));
  EXPECT_GE(below, T(1) - 4 * std::numeric_limits<T>::epsilon());
}

TEST(Polynomial, IntervalsMeetAtTheirSeams) {
  looks_up_interval_and_position<double>();
  looks_up_interval_and_position<float>();
}

TEST(Polynomial, OneIntervalMapsZeroAndOneToItsEnds) {
  constexpr double c[1][2] = {{0, 1}};
  EXPECT_EQ(interval_polynomial<double>(c, 0.0), -1);
  EXPECT_EQ(interval_polynomial<double>(c, 1.0), 1);
}

TEST(Polynomial, ArgumentsOutsideAreSafe) {
  constexpr double c[4][2] = {{0, 1}, {100, 1}, {200, 1}, {300, 1}};
  const double infinity = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(interval_polynomial<double>(c, -1.0), -9.0);
  EXPECT_EQ(interval_polynomial<double>(c, 2.0), 300 + 9.0);
  EXPECT_EQ(interval_polynomial<double>(c, infinity), infinity);
  EXPECT_TRUE(std::isnan(interval_polynomial<double>(c, nan)));
}

}  // namespace
}  // namespace pellucid
