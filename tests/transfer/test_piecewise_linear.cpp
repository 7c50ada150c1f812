// SPDX-License-Identifier: Apache-2.0
#include "pellucid/transfer/piecewise_linear.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace pellucid::test_piecewise_linear {
namespace {

template <class T>
class PiecewiseLinearTable : public testing::Test {
 public:
  // A ramp, a jump at 2, a plateau, a fall to nothing.
  T value[6] = {T(0), T(1), T(2), T(2), T(3), T(4)};
  Material<T> material[6] = {{T(0), {T(0), T(0), T(0)}}, {T(4), {T(1), T(0), T(0)}},
                             {T(4), {T(1), T(1), T(0)}}, {T(9), {T(0), T(0), T(8)}},
                             {T(9), {T(0), T(0), T(8)}}, {T(0), {T(0), T(0), T(0)}}};
  PiecewiseLinear<T> table{value, material, 6};
};
using NumberTypes = testing::Types<float, double>;
TYPED_TEST_SUITE(PiecewiseLinearTable, NumberTypes);

TYPED_TEST(PiecewiseLinearTable, IntervalCountsTheValuesNotAbove) {
  using T = TypeParam;
  const auto& transfer = this->table;
  EXPECT_EQ(transfer.interval(T(-1)), 0);
  EXPECT_EQ(transfer.interval(std::nextafter(T(0), T(-1))), 0);
  EXPECT_EQ(transfer.interval(T(0)), 1);
  EXPECT_EQ(transfer.interval(T(-0.0)), 1);
  EXPECT_EQ(transfer.interval(std::nextafter(T(2), T(0))), 2);
  EXPECT_EQ(transfer.interval(T(2)), 4);  // the jump: its right side
  EXPECT_EQ(transfer.interval(T(4)), 6);
  EXPECT_EQ(transfer.interval(std::numeric_limits<T>::max()), 6);
  // Any count, every position, against a plain count.
  T many[40];
  for (int n = 1; n <= 40; ++n) {
    for (int i = 0; i < n; ++i) many[i] = T(i / 2);  // pairs
    const PiecewiseLinear<T> pairs{many, nullptr, n};
    for (T v = T(-1); v < T(22); v += T(0.5)) {
      int expected = 0;
      for (int i = 0; i < n; ++i) expected += many[i] <= v;
      ASSERT_EQ(pairs.interval(v), expected);
    }
  }
}

TYPED_TEST(PiecewiseLinearTable, EvaluatesBetweenAtAndOutsideOfThePoints) {
  using T = TypeParam;
  const auto& transfer = this->table;
  EXPECT_EQ(transfer.evaluate(T(-5)).extinction, T(0));
  EXPECT_EQ(transfer.evaluate(T(0.25)).extinction, T(1));
  EXPECT_EQ(transfer.evaluate(T(0.25)).color.r, T(0.25));
  EXPECT_EQ(transfer.evaluate(T(1)).extinction, T(4));
  EXPECT_EQ(transfer.evaluate(T(1.5)).color.g, T(0.5));
  EXPECT_EQ(transfer.evaluate(T(2)).extinction, T(9));
  EXPECT_EQ(transfer.evaluate(T(3.5)).extinction, T(4.5));
  EXPECT_EQ(transfer.evaluate(T(4)).extinction, T(0));
  EXPECT_EQ(transfer.evaluate(T(99)).extinction, T(0));
  // The limits from inside on both sides of the jump.
  EXPECT_EQ(transfer.evaluate_in(2, T(2)).extinction, T(4));
  EXPECT_EQ(transfer.evaluate_in(4, T(2)).extinction, T(9));
}

/// Close to a point where the extinction vanishes it keeps its relative precision, from both sides.
TYPED_TEST(PiecewiseLinearTable, VanishingExtinctionDoesNotCancel) {
  using T = TypeParam;
  const T width = T(8) * rounding_unit<T>;
  const T v = T(4) - width;
  EXPECT_EQ(this->table.evaluate(v).extinction, T(9) * (T(4) - v));
  EXPECT_EQ(this->table.evaluate(width).extinction, T(4) * width);
}

TYPED_TEST(PiecewiseLinearTable, ExtinctionInARangeOfIntervals) {
  using T = TypeParam;
  const auto& transfer = this->table;
  EXPECT_FALSE(transfer.has_extinction(0, 0));
  EXPECT_TRUE(transfer.has_extinction(0, 1));
  EXPECT_TRUE(transfer.has_extinction(1, 1));
  EXPECT_TRUE(transfer.has_extinction(5, 5));
  EXPECT_FALSE(transfer.has_extinction(6, 6));
  EXPECT_TRUE(transfer.has_extinction(0, 6));
  const PiecewiseLinear<T> one{this->value, this->material, 1};
  EXPECT_FALSE(one.has_extinction(0, 1));
  const PiecewiseLinear<T> dense{this->value + 1, this->material + 1, 1};
  EXPECT_TRUE(dense.has_extinction(0, 0));
  EXPECT_TRUE(dense.has_extinction(1, 1));
}

}  // namespace
}  // namespace pellucid::test_piecewise_linear
