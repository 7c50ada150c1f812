// SPDX-License-Identifier: Apache-2.0
#include "pellucid/math/error_function.h"

#include <gtest/gtest.h>

#include <boost/math/special_functions/erf.hpp>

#include "tests/math/sweep.h"

namespace pellucid::test {
namespace {

template <class T>
constexpr T infinity = std::numeric_limits<T>::infinity();
template <class T>
constexpr bool single = sizeof(T) == sizeof(float);

template <class T>
class ErrorFunction : public testing::Test {};
using NumberTypes = testing::Types<float, double>;
TYPED_TEST_SUITE(ErrorFunction, NumberTypes);

/// The truth itself: three derivations that share nothing agree.
TEST(WideErrorFunction, AgreesWithBoostMath) {
  for (const double x :
       {1e-30, 1e-3, 0.25, 0.5, 1.0, 1.999, 2.001, 3.5, 4.999, 5.001, 8.0, 11.9, 12.1, 26.0}) {
    const Wide wide = x;
    EXPECT_LE(abs(wide_erf(wide) / boost::math::erf(wide) - 1), Wide("1e-40")) << x;
    EXPECT_LE(abs(wide_erf(-wide) / boost::math::erf(-wide) - 1), Wide("1e-40")) << x;
    EXPECT_LE(abs(wide_erfc(wide) / boost::math::erfc(wide) - 1), Wide("1e-35")) << x;
    EXPECT_LE(abs(wide_erfc(-wide) / boost::math::erfc(-wide) - 1), Wide("1e-40")) << x;
    EXPECT_LE(abs(wide_erfcx(wide) / (exp(wide * wide) * boost::math::erfc(wide)) - 1),
              Wide("1e-35"))
        << x;
  }
}

TYPED_TEST(ErrorFunction, ErfcxHasTheStatedError) {
  using T = TypeParam;
  const auto function = [](T x) { return erfcx(x); };
  const T huge = std::numeric_limits<T>::max() / 8;
  for (const T range : {T(4), huge}) {
    const std::vector<T> positive = arguments<T>(0, range, {}, 3000);
    EXPECT_LE(relative_errors("erfcx, x >= 0", positive, function, wide_erfcx).largest(),
              single<T> ? 6.2L : 5.6L);
    for (const T x : positive) {
      ASSERT_EQ(erfcx(x), erfcx_nonnegative(x));
    }
  }
  const T overflow = single<T> ? T(-9.38) : T(-26.62);
  const auto truth = [](const Wide& x) { return exp(x * x) * wide_erfc(x); };
  EXPECT_LE(relative_errors("erfcx, x < 0", arguments<T>(overflow, 0, {-1, T(-0.5)}, 3000),
                            function, truth)
                .largest(),
            single<T> ? 6.2L : 5.6L);
}

TYPED_TEST(ErrorFunction, ErfHasTheStatedError) {
  using T = TypeParam;
  const auto function = [](T x) { return pellucid::erf(x); };
  for (const T range : {T(2), T(30)}) {
    EXPECT_LE(relative_errors("erf", arguments<T>(-range, range, {-1, 1}, 3000), function, wide_erf)
                  .largest(),
              2.8L);
  }
}

TYPED_TEST(ErrorFunction, ErfcHasTheStatedError) {
  using T = TypeParam;
  const auto function = [](T x) { return pellucid::erfc(x); };
  const T underflow = single<T> ? T(9.19) : T(26.5);
  for (const T range : {T(3), underflow}) {
    EXPECT_LE(relative_errors("erfc", arguments<T>(-range, range, {T(-0.5), T(0.5)}, 4000),
                              function, wide_erfc)
                  .largest(),
              single<T> ? 7.2L : 7.0L);
  }
}

TYPED_TEST(ErrorFunction, TheDenormalTailOfErfcIsOffByOneStepMore) {
  using T = TypeParam;
  const Wide step = std::numeric_limits<T>::denorm_min();
  int denormals = 0;
  for (T x = single<T> ? T(9.19) : T(26.5); x < (single<T> ? T(10.5) : T(27.5)); x += T(0.001)) {
    const Wide truth = wide_erfc(Wide(x));
    if (truth < std::numeric_limits<T>::min()) {
      ASSERT_LE(abs(Wide(pellucid::erfc(x)) - truth), truth * Wide(7.2L * unit_of<T>) + step) << x;
      denormals += truth > step ? 1 : 0;
    }
  }
  EXPECT_GT(denormals, 500);
}

TYPED_TEST(ErrorFunction, Symmetries) {
  using T = TypeParam;
  for (const T x : arguments<T>(0, T(30), {T(0.5), 1}, 500)) {
    EXPECT_EQ(pellucid::erf(-x), -pellucid::erf(x)) << x;
    EXPECT_GE(pellucid::erf(x), T(0));
    EXPECT_LE(pellucid::erf(x), T(1));
    EXPECT_GE(pellucid::erfc(x), T(0));
    EXPECT_LE(pellucid::erfc(-x), T(2));
  }
}

TYPED_TEST(ErrorFunction, Limits) {
  using T = TypeParam;
  EXPECT_EQ(pellucid::erf(T(0)), T(0));
  EXPECT_FALSE(std::signbit(pellucid::erf(T(0))));
  EXPECT_TRUE(std::signbit(pellucid::erf(-T(0))));
  EXPECT_EQ(pellucid::erfc(T(0)), T(1));
  for (const T huge : {T(30), T(1e6), largest<T>, infinity<T>}) {
    EXPECT_EQ(pellucid::erf(huge), T(1));
    EXPECT_EQ(pellucid::erf(-huge), T(-1));
    EXPECT_EQ(pellucid::erfc(huge), T(0));
    EXPECT_EQ(pellucid::erfc(-huge), T(2));
    EXPECT_EQ(erfcx(-huge), infinity<T>);
  }
  EXPECT_EQ(erfcx(infinity<T>), T(0));
  EXPECT_NEAR(erfcx(T(0)), T(1), 6 * std::numeric_limits<T>::epsilon());
  // A denormal argument of erf is not lost: erf(x) ~ 1.128 x.
  const T denormal = std::numeric_limits<T>::denorm_min() * 1000;
  EXPECT_EQ(pellucid::erf(denormal), std::numeric_limits<T>::denorm_min() * 1128);
  const T nan = std::numeric_limits<T>::quiet_NaN();
  EXPECT_TRUE(std::isnan(pellucid::erf(nan)));
  EXPECT_TRUE(std::isnan(pellucid::erfc(nan)));
  EXPECT_TRUE(std::isnan(erfcx(nan)));
}

}  // namespace
}  // namespace pellucid::test
