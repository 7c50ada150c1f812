// SPDX-License-Identifier: Apache-2.0
#include "pellucid/segment/constant.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/segment/table_rows.h"
#include "tests/support/wide_functions.h"

namespace pellucid::test_constant {
namespace {

template <class T>
class Constant : public testing::Test {};
using NumberTypes = testing::Types<float, double>;
TYPED_TEST_SUITE(Constant, NumberTypes);

/// From the smallest normal number to where nothing passes, both sides of the switch at 2.
TYPED_TEST(Constant, AttenuationIsWithinFourUnits) {
  using T = TypeParam;
  const std::string name = test::number_name<T>();
  test::ErrorRecord opacity(name + " opacity"), transparency(name + " transparency, absolute");
  const auto judge = [&](T x) {
    const test::Wide depth(static_cast<long double>(x));
    const Attenuation<T> a = attenuation(x);
    opacity.add(test::relative_error_in_u(
                    a.opacity,
                    static_cast<long double>(test::Wide(depth * test::wide_expm1_quotient(depth)))),
                std::to_string(x));
    transparency.add(test::absolute_error_in_u(a.transparency,
                                               static_cast<long double>(test::Wide(exp(-depth)))),
                     std::to_string(x));
  };
  for (T x = std::numeric_limits<T>::min() * T(4); x < T(1e4); x *= x < T(1e-9) ? T(3) : T(1.01)) {
    judge(x);
  }
  for (T x = T(2) - 200 * rounding_unit<T>; x < T(2) + 400 * rounding_unit<T>;
       x += 4 * rounding_unit<T>) {
    judge(x);
  }
  opacity.print();
  transparency.print();
  EXPECT_LE(opacity.largest(), 4);
  EXPECT_LE(transparency.largest(), 4);
}

TYPED_TEST(Constant, ExtremesOfTheDepth) {
  using T = TypeParam;
  using Limits = std::numeric_limits<T>;
  for (const T zero : {T(0), T(-0.0)}) {
    EXPECT_EQ(attenuation(zero).opacity, T(0));
    EXPECT_EQ(attenuation(zero).transparency, T(1));
  }
  EXPECT_EQ(attenuation(Limits::denorm_min()).opacity, Limits::denorm_min());
  for (const T x : {T(1e6), Limits::max(), Limits::infinity()}) {
    EXPECT_EQ(attenuation(x).opacity, T(1));
    EXPECT_EQ(attenuation(x).transparency, T(0));
  }
}

TYPED_TEST(Constant, SegmentIsColorTimesOpacity) {
  using T = TypeParam;
  const Rgb<T> color{T(0.25), T(0), T(3)};
  const SegmentResult<T> s = constant_segment(T(0.5), color, T(3));
  EXPECT_EQ(s.optical_depth, T(1.5));
  EXPECT_EQ(s.radiance, s.opacity * color);
  EXPECT_NEAR(static_cast<double>(s.opacity), 0.7768698398515702, 8 * double(rounding_unit<T>));
  EXPECT_EQ(constant_segment(T(0), color, T(1e6)).radiance, Rgb<T>{});
  EXPECT_EQ(constant_segment(T(1e6), color, T(0)).radiance, Rgb<T>{});
}

}  // namespace
}  // namespace pellucid::test_constant
