// SPDX-License-Identifier: Apache-2.0
#include "pellucid/math/cubic_extremes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/math_bernstein/wide_cubic.h"
#include "tests/support/accuracy.h"

namespace pellucid {
namespace {

template <class T>
class CubicExtremes : public testing::Test {};
using NumberTypes = testing::Types<float, double>;
TYPED_TEST_SUITE(CubicExtremes, NumberTypes);

/// The largest value by samples and a search around the best one, in long double.
template <class T>
long double largest_by_search(const CubicBernstein<T>& f) {
  constexpr int count = 256;
  long double best = -INFINITY;
  int at = 0;
  for (int i = 0; i <= count; ++i) {
    const long double value = test::wide_value(f, i / static_cast<long double>(count));
    if (value > best) {
      best = value;
      at = i;
    }
  }
  long double from = std::max(at - 1, 0) / static_cast<long double>(count),
              to = std::min(at + 1, count) / static_cast<long double>(count);
  for (int i = 0; i < 100; ++i) {
    const long double left = from + (to - from) / 3, right = to - (to - from) / 3;
    const long double at_left = test::wide_value(f, left), at_right = test::wide_value(f, right);
    best = std::max({best, at_left, at_right});
    (at_left < at_right ? from : to) = at_left < at_right ? left : right;
  }
  return best;
}

template <class T>
CubicBernstein<T> negated(const CubicBernstein<T>& f) {
  return {{-f.b[0], -f.b[1], -f.b[2], -f.b[3]}};
}

TYPED_TEST(CubicExtremes, AreWithinThreeUnits) {
  using T = TypeParam;
  std::mt19937_64 random(11);
  const std::string name = is_single<T> ? "float" : "double";
  test::ErrorRecord most(name + " largest value / max|b|");
  int inside = 0;
  for (int i = 0; i < 20000; ++i) {
    const CubicBernstein<T> f = test::some_cubic<T>(random);
    const long double size = static_cast<long double>(test::largest_coefficient(f));
    if (size == 0) continue;
    const T found = largest_value(f);
    most.add(test::absolute_error_in_u(found, largest_by_search(f)) / size, std::to_string(i));
    ASSERT_LE(found, f.hull_max());
    ASSERT_GE(found, max(f.b[0], f.b[3]));
    if (found > max(f.b[0], f.b[3])) ++inside;
    ASSERT_EQ(smallest_value(negated(f)), -found);
    ASSERT_LE(smallest_value(f), min(f.b[0], f.b[3]));
  }
  most.print();
  EXPECT_GT(inside, 4000);
  EXPECT_LE(most.largest(), 3);
}

TYPED_TEST(CubicExtremes, KnownValues) {
  using T = TypeParam;
  constexpr double u = static_cast<double>(rounding_unit<T>);
  // Chebyshev's T3: ±1 at the turns and at the ends.
  const CubicBernstein<T> t3{{T(-1), T(5), T(-5), T(1)}};
  EXPECT_NEAR(static_cast<double>(largest_value(t3)), 1, 30 * u);
  EXPECT_NEAR(static_cast<double>(smallest_value(t3)), -1, 30 * u);
  // 4 t (1-t) · 9/4: the parabola's top.
  EXPECT_EQ(largest_value(CubicBernstein<T>{{T(0), T(3), T(3), T(0)}}), T(2.25));
  // One voxel of 1 among zeros, along the diagonal of the cells beside it: 3 t² (1-t) has its top,
  // 4/9, at 2/3.
  EXPECT_NEAR(static_cast<double>(largest_value(CubicBernstein<T>{{T(0), T(0), T(1), T(0)}})),
              4.0 / 9, 6 * u);
  EXPECT_NEAR(static_cast<double>(largest_value(CubicBernstein<T>{{T(0), T(1), T(0), T(0)}})),
              4.0 / 9, 6 * u);
  // Ends are exact, and so are constants.
  EXPECT_EQ(largest_value(CubicBernstein<T>{{T(0), T(0.1f), T(0.2f), T(0.3f)}}), T(0.3f));
  EXPECT_EQ(smallest_value(CubicBernstein<T>{{T(0.1f), T(0.1f), T(0.1f), T(0.1f)}}), T(0.1f));
}

TYPED_TEST(CubicExtremes, HugeAndTinyCoefficients) {
  using T = TypeParam;
  for (const T scale : {T(1e-36), T(1e-12), T(1e12), T(1e36)}) {
    const CubicBernstein<T> f{{T(0), T(3) * scale, T(3) * scale, T(0)}};
    EXPECT_NEAR(static_cast<double>(largest_value(f) / scale), 2.25,
                6 * 3 * static_cast<double>(rounding_unit<T>));
  }
}

}  // namespace
}  // namespace pellucid
