// SPDX-License-Identifier: Apache-2.0
#include "pellucid/math/dawson.h"

#include <gtest/gtest.h>

#include <boost/math/quadrature/tanh_sinh.hpp>

#include "tests/math/sweep.h"

namespace pellucid::test {
namespace {

template <class T>
class Dawson : public testing::Test {};
using NumberTypes = testing::Types<float, double>;
TYPED_TEST_SUITE(Dawson, NumberTypes);

/// The truth itself against the defining integral.
TEST(WideDawson, AgreesWithQuadrature) {
  using Quadrature = boost::math::quadrature::tanh_sinh<Wide>;
  Quadrature quadrature;
  for (const double x : {1e-3, 0.5, 0.924, 2.0, 6.0, 11.9, 12.1}) {
    const Wide wide = x;
    const Wide integral = wide / 2 * quadrature.integrate([&](const Wide& z) {
      return exp(wide * wide * ((1 + z) * (1 + z) / 4 - 1));
    });
    EXPECT_LE(abs(wide_dawson(wide) / integral - 1), Wide("1e-30")) << x;
  }
}

TYPED_TEST(Dawson, HasTheStatedError) {
  using T = TypeParam;
  const bool single = sizeof(T) == sizeof(float);
  const T huge = std::numeric_limits<T>::max() / 8;
  for (const T range : {T(2), huge}) {
    const std::vector<T> all = arguments<T>(-range, range, {T(-0.5), T(0.5)}, 3000);
    EXPECT_LE(relative_errors(
                  "dawson", all, [](T x) { return dawson(x); },
                  [](const Wide& x) { return x == 0 ? Wide(0) : wide_dawson(x); })
                  .largest(),
              single ? 7.2L : 7.4L);
    ErrorRecord absolute("dawson, absolute");
    for (const T x : all) {
      const auto truth = x == 0 ? 0 : static_cast<long double>(wide_dawson(Wide(x)));
      absolute.add(absolute_error_in_u(dawson(x), truth), [x] { return at(x); });
    }
    absolute.print();
    EXPECT_LE(absolute.largest(), 3.0L);
  }
}

TYPED_TEST(Dawson, Limits) {
  using T = TypeParam;
  const T infinity = std::numeric_limits<T>::infinity();
  EXPECT_FALSE(std::signbit(dawson(T(0))));
  EXPECT_TRUE(std::signbit(dawson(-T(0))));
  EXPECT_EQ(dawson(T(0)), T(0));
  EXPECT_EQ(dawson(infinity), T(0));
  EXPECT_EQ(dawson(-infinity), T(0));
  EXPECT_GT(dawson(std::numeric_limits<T>::max()), T(0));
  const T denormal = std::numeric_limits<T>::denorm_min() * 3;
  EXPECT_EQ(dawson(denormal), denormal);
  EXPECT_EQ(dawson(-denormal), -denormal);
  EXPECT_TRUE(std::isnan(dawson(std::numeric_limits<T>::quiet_NaN())));
  for (const T x : arguments<T>(0, T(30), {T(0.5)}, 500)) {
    EXPECT_EQ(dawson(-x), -dawson(x)) << x;
  }
}

}  // namespace
}  // namespace pellucid::test
