// SPDX-License-Identifier: Apache-2.0
#include "pellucid/segment/gaussian_linear.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/segment/line_exponent.h"
#include "tests/segment/random_cells.h"
#include "tests/support/accuracy.h"

namespace pellucid::test_gaussian_linear {
namespace {

/// A primitive along linear data: near the center or far, some constant, some through it.
template <class T>
struct Case {
  Gaussian<T> primitive;
  LinearBernstein<T> data[max_channels];
  T front[max_channels], back[max_channels];
  test::LineExponent<T> exponent{primitive, front, back};

  explicit Case(std::mt19937_64& random) {
    const auto pick = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    std::normal_distribution<double> normal;
    Gaussian<T>& g = primitive;
    g.channels = 1 + pick(8);
    g.rows = 1 + pick(g.channels);
    const double size = test::log_uniform(random, 1e-2, 1e3);
    const bool constant = pick(16) == 0, through = pick(8) == 0;
    for (int c = 0; c < g.channels; ++c) {
      const double a = normal(random), b = constant ? a : normal(random);
      data[c] = {{static_cast<T>(a), static_cast<T>(b)}};
      front[c] = data[c].b[0];
      back[c] = data[c].b[1];
      const double center = through ? 0.3 * a + 0.7 * b : 3 * normal(random);
      g.center[c] = static_cast<T>(center);
      for (int i = 0; i < g.rows; ++i) {
        g.matrix[i][c] = static_cast<T>(size * normal(random));
      }
    }
  }

  /// What rounding makes of |p|² where p is small beside what it is the difference of.
  long double rounding() const {
    long double size = 0;
    for (int i = 0; i < primitive.rows; ++i) {
      long double sum = 0;
      for (int c = 0; c < primitive.channels; ++c) {
        const long double away = std::max(std::fabs(static_cast<long double>(data[c].b[0])),
                                          std::fabs(static_cast<long double>(data[c].b[1]))) +
                                 std::fabs(static_cast<long double>(primitive.center[c]));
        sum += std::fabs(static_cast<long double>(primitive.matrix[i][c])) * away;
      }
      size += sum * sum;
    }
    return 16 * static_cast<long double>(rounding_unit<T>) * size;
  }
};

template <class T>
class GaussianLinears : public testing::Test {};
using Numbers = testing::Types<float, double>;
TYPED_TEST_SUITE(GaussianLinears, Numbers);

TYPED_TEST(GaussianLinears, BoundsAreThoseOfTheExponent) {
  using T = TypeParam;
  std::mt19937_64 random(71);
  long double loosest = 0;
  for (long i = 0; i < test::span_count(20000); ++i) {
    const Case<T> at(random);
    const GaussianLinear<T> line(at.primitive, at.data);
    const long double least = at.exponent.least(), most = std::max(at.exponent(0), at.exponent(1));
    const long double slack = at.rounding();
    ASSERT_LE(static_cast<long double>(line.lower()), least + slack) << i;
    ASSERT_GE(line.lower(), T(0)) << i;
    ASSERT_NEAR(static_cast<double>(line.upper()), static_cast<double>(most),
                static_cast<double>(slack))
        << i;
    loosest =
        std::max(loosest, (least - static_cast<long double>(line.lower())) / (slack + 1e-30L));
    const auto& l = line.line();
    // |front|² + slope u + |d|² u² is the exponent.
    for (const double u : {0.25, 0.5, 1.0}) {
      const long double here = at.exponent(0) + static_cast<long double>(line.slope(l)) * u +
                               static_cast<long double>(l.squared_length) * u * u;
      ASSERT_NEAR(static_cast<double>(here), static_cast<double>(at.exponent(u)),
                  static_cast<double>(4 * slack))
          << i;
    }
  }
  EXPECT_LT(loosest, 2);
}

TYPED_TEST(GaussianLinears, NothingNearIsTakenForFar) {
  using T = TypeParam;
  std::mt19937_64 random(72);
  long near = 0, far = 0, wrong = 0;
  for (long i = 0; i < test::span_count(20000); ++i) {
    const Case<T> at(random);
    const GaussianLinear<T> line(at.primitive, at.data);
    const long double least = at.exponent.least(), slack = at.rounding();
    const T square = static_cast<T>(static_cast<double>(least) *
                                    std::exp(std::uniform_real_distribution<>(-2, 2)(random)));
    if (least + slack < static_cast<long double>(square)) {
      ++near;
      ASSERT_TRUE(line.comes_within(square)) << i;
    } else if (least > static_cast<long double>(square) + 4 * slack) {
      ++far;
      wrong += line.comes_within(square);
    }
  }
  EXPECT_GT(near, far / 4);
  EXPECT_GT(far, 1000);
  EXPECT_EQ(wrong, 0);
}

TEST(GaussianLinear, WhatIsNoNumberIsNotFar) {
  Gaussian<double> g;
  g.matrix[0][0] = 10;
  LinearBernstein<double> data{{5, 6}};
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(GaussianLinear<double>(g, &data).comes_within(100));
  EXPECT_TRUE(GaussianLinear<double>(g, &data).comes_within(nan));
  // Ends on both sides, far away.
  Gaussian<float> narrow;
  narrow.matrix[0][0] = 1;
  const LinearBernstein<float> far{{-1e9F, 0.9e9F}};
  EXPECT_TRUE(GaussianLinear<float>(narrow, &far).comes_within(1));
}

}  // namespace
}  // namespace pellucid::test_gaussian_linear
