// SPDX-License-Identifier: Apache-2.0
#include "pellucid/math/exponential.h"

#include <gtest/gtest.h>

#include "pellucid/math/expm1_quotient_to_4.h"
#include "tests/math/sweep.h"

namespace pellucid::test {
namespace {

template <class T>
constexpr T infinity = std::numeric_limits<T>::infinity();
template <class T>
constexpr T quiet_nan = std::numeric_limits<T>::quiet_NaN();

template <class T>
class Exponential : public testing::Test {};
using NumberTypes = testing::Types<float, double>;
TYPED_TEST_SUITE(Exponential, NumberTypes);

/// Where e^x, and (1 + |x|) e^|x|, still fit.
template <class T>
constexpr T overflow = sizeof(T) == sizeof(float) ? T(88) : T(709);
template <class T>
constexpr T overflow_of_derivative = sizeof(T) == sizeof(float) ? T(84) : T(702);

TYPED_TEST(Exponential, Expm1QuotientHasTheStatedError) {
  using T = TypeParam;
  const auto function = [](T x) { return expm1_quotient(x); };
  const std::vector<T> seams = {-2, 0, 2};
  for (const T range : {T(2.5), overflow<T>}) {
    EXPECT_LE(relative_errors("expm1_quotient", arguments<T>(-range, range, seams, 3000), function,
                              wide_expm1_quotient)
                  .largest(),
              3.3L);
  }
}

TYPED_TEST(Exponential, Expm1QuotientTo4HasTheStatedError) {
  using T = TypeParam;
  const auto function = [](T t) { return expm1_quotient_to_4(t); };
  const auto truth = [](const Wide& t) { return wide_expm1_quotient(Wide(4 * t)); };
  // The worst that long search found.
  const std::vector<T> seams = {
      0, T(0.5), T(0.97901826760728627), T(0.979999006), T(0.9800828945795923), 1};
  EXPECT_LE(
      relative_errors("expm1_quotient_to_4", arguments<T>(T(0), T(1), seams, 3000), function, truth)
          .largest(),
      sizeof(T) == sizeof(float) ? 4.2L : 3.6L);
}

TYPED_TEST(Exponential, Expm1QuotientDerivativeHasTheStatedError) {
  using T = TypeParam;
  const auto function = [](T x) { return expm1_quotient_derivative(x); };
  const std::vector<T> seams = {-2, 0, 2};
  for (const T range : {T(2.5), overflow_of_derivative<T>}) {
    EXPECT_LE(relative_errors("expm1_quotient_derivative", arguments<T>(-range, range, seams, 3000),
                              function, wide_expm1_quotient_derivative)
                  .largest(),
              4.2L);
  }
}

TYPED_TEST(Exponential, OpacityOfAnOpticalDepthHasTheStatedError) {
  using T = TypeParam;
  const auto function = [](T x) { return one_minus_exp_neg(x); };
  const auto truth = [](const Wide& x) { return x * wide_expm1_quotient(x); };
  for (const T range : {T(2.5), T(1000)}) {
    EXPECT_LE(relative_errors("one_minus_exp_neg, x >= 0",
                              arguments<T>(std::numeric_limits<T>::min(), range, {2}, 3000),
                              function, truth)
                  .largest(),
              3.7L);
  }
  EXPECT_LE(relative_errors("one_minus_exp_neg, x < 0",
                            arguments<T>(T(-4), -std::numeric_limits<T>::min(), {-2}, 3000),
                            function, truth)
                .largest(),
            4.0L);
}

TYPED_TEST(Exponential, OpacityIsAnOpacity) {
  using T = TypeParam;
  T previous = 0;
  for (T x = std::numeric_limits<T>::denorm_min(); x < std::numeric_limits<T>::max() / 4;
       x *= T(1.37)) {
    const T opacity = one_minus_exp_neg(x);
    EXPECT_GE(opacity, previous) << x;
    EXPECT_LE(opacity, T(1)) << x;
    EXPECT_LE(opacity, x);
    previous = opacity;
    x = std::nextafter(x, infinity<T>);  // leaves the denormals, which 1.37 alone does not
  }
  EXPECT_EQ(previous, T(1));
  // Thin beyond all digits of 1 - e^(-x): the opacity is the optical depth, denormals included.
  const T denormal = std::numeric_limits<T>::denorm_min() * 5;
  EXPECT_EQ(one_minus_exp_neg(denormal), denormal);
  EXPECT_EQ(one_minus_exp_neg(T(0)), T(0));
  EXPECT_FALSE(std::signbit(one_minus_exp_neg(T(0))));
  EXPECT_TRUE(std::signbit(one_minus_exp_neg(-T(0))));
}

TYPED_TEST(Exponential, SquaresInTheExponentHaveTheStatedError) {
  using T = TypeParam;
  const bool single = sizeof(T) == sizeof(float);
  const T underflow = single ? T(9.34) : T(26.6);
  EXPECT_LE(relative_errors(
                "exp_minus_square", arguments<T>(-underflow, underflow, {0}, 4000),
                [](T x) { return exp_minus_square(x); }, [](const Wide& x) { return exp(-x * x); })
                .largest(),
            3.1L);
  const T large = single ? T(9.419) : T(26.64);
  EXPECT_LE(relative_errors(
                "exp_square", arguments<T>(-large, large, {0}, 4000),
                [](T x) { return exp_square(x); }, [](const Wide& x) { return exp(x * x); })
                .largest(),
            3.1L);
}

TYPED_TEST(Exponential, TheDenormalTailOfExpMinusSquareIsOffByOneStepMore) {
  using T = TypeParam;
  const bool single = sizeof(T) == sizeof(float);
  const Wide step = std::numeric_limits<T>::denorm_min();
  int denormals = 0;
  for (T x = single ? T(9.3) : T(26.5); x < (single ? T(10.5) : T(27.5)); x += T(0.001)) {
    const Wide truth = exp(-Wide(x) * Wide(x));
    if (truth < std::numeric_limits<T>::min()) {
      ASSERT_LE(abs(Wide(exp_minus_square(x)) - truth), truth * Wide(3.1L * unit_of<T>) + step)
          << x;
      denormals += truth > step ? 1 : 0;
    }
  }
  EXPECT_GT(denormals, 500);
}

TYPED_TEST(Exponential, TheSquareIsExact) {
  using T = TypeParam;
  const T end = sizeof(T) == sizeof(float) ? T(1e15) : T(1e145);
  for (const T x : arguments<T>(-end, end, {1}, 4000)) {
    if (std::fabs(x) < 1 / end * 1000) {
      continue;
    }
    const ExactSquare<T> exact = exact_square(x);
    EXPECT_EQ(Wide(exact.square) + Wide(exact.residual), Wide(x) * Wide(x)) << x;
    EXPECT_EQ(exact.square, x * x);
  }
}

TYPED_TEST(Exponential, Limits) {
  using T = TypeParam;
  EXPECT_EQ(expm1_quotient(T(0)), T(1));
  EXPECT_EQ(expm1_quotient(-T(0)), T(1));
  EXPECT_EQ(expm1_quotient(infinity<T>), T(0));
  EXPECT_EQ(expm1_quotient(-infinity<T>), infinity<T>);
  EXPECT_EQ(expm1_quotient(T(-800)), infinity<T>);
  EXPECT_EQ(expm1_quotient_derivative(T(0)), T(-0.5));
  EXPECT_EQ(expm1_quotient_derivative(infinity<T>), T(0));
  EXPECT_EQ(expm1_quotient_derivative(-infinity<T>), -infinity<T>);
  EXPECT_EQ(expm1_quotient_derivative(T(-800)), -infinity<T>);
  EXPECT_EQ(expm1_quotient_derivative(largest<T>), T(0));
  EXPECT_EQ(one_minus_exp_neg(infinity<T>), T(1));
  EXPECT_EQ(one_minus_exp_neg(largest<T>), T(1));
  EXPECT_EQ(one_minus_exp_neg(-infinity<T>), -infinity<T>);
  EXPECT_EQ(exp_minus_square(T(0)), T(1));
  EXPECT_EQ(exp_square(T(0)), T(1));
  for (const T huge : {T(28), T(1e6), largest<T>, infinity<T>}) {
    EXPECT_EQ(exp_minus_square(huge), T(0));
    EXPECT_EQ(exp_minus_square(-huge), T(0));
    EXPECT_EQ(exp_square(huge), infinity<T>);
    EXPECT_EQ(exp_square(-huge), infinity<T>);
  }
  const T nan = quiet_nan<T>;
  EXPECT_TRUE(std::isnan(expm1_quotient(nan)));
  EXPECT_TRUE(std::isnan(expm1_quotient_derivative(nan)));
  EXPECT_TRUE(std::isnan(one_minus_exp_neg(nan)));
  EXPECT_TRUE(std::isnan(exp_minus_square(nan)));
  EXPECT_TRUE(std::isnan(exp_square(nan)));
}

}  // namespace
}  // namespace pellucid::test
