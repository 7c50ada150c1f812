// SPDX-License-Identifier: Apache-2.0
#include "pellucid/simd/scalar.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

/// The vocabulary of the kernels at width 1. The same statements hold lane by lane for any batch
/// type.
namespace pellucid {
namespace {

template <class T>
class Scalar : public testing::Test {
 protected:
  static constexpr T not_a_number = std::numeric_limits<T>::quiet_NaN();
  static constexpr T infinity = std::numeric_limits<T>::infinity();
};
using NumberTypes = testing::Types<float, double>;
TYPED_TEST_SUITE(Scalar, NumberTypes);

static_assert(is_single<float> && !is_single<double>);
static_assert(std::is_same_v<scalar_t<float>, float> && std::is_same_v<scalar_t<double>, double>);
static_assert(rounding_unit<float> == 0x1p-24f && rounding_unit<double> == 0x1p-53);
static_assert(select(true, 1, 2) == 1 && select(false, 1, 2) == 2);
static_assert(any(true) && all(true) && !any(false) && !all(false));
static_assert(min(1.0, 2.0) == 1.0 && max(1.0, 2.0) == 2.0 && clamp(3.0f, 0.0f, 1.0f) == 1.0f);

static_assert(lanes<float> == 1 && std::is_same_v<mask_t<double>, bool>);
static_assert(std::is_same_v<index_t<double>, int>);
static_assert(none(false) && !none(true) && count(true) == 1 && count(false) == 0);
static_assert(bits(true) == 1u && bits(false) == 0u);

/// Of one lane they are what the language has; batches are held against the same statements.
TYPED_TEST(Scalar, MasksConversionsAndTablesOfOneLane) {
  using T = TypeParam;
  T target = 1;
  assign(false, target, T(2));
  EXPECT_EQ(target, T(1));
  assign(true, target, T(3));
  EXPECT_EQ(target, T(3));
  EXPECT_EQ(convert<int>(T(-2.75)), -2);
  EXPECT_EQ(convert<float>(T(0.1)), 0.1f);
  constexpr T table[] = {10, 11, 12, 13};
  EXPECT_EQ(gather(table, 2), T(12));
  EXPECT_EQ(lookup(table, 3), T(13));
  constexpr float records[] = {0, 1, 2, 3, 4, 5, 6, 7};
  float fields[4] = {};
  load_records<4>(records, 1, fields);
  for (int k = 0; k < 4; ++k) EXPECT_EQ(fields[k], static_cast<float>(4 + k));
  // Rounded twice.
  const T x = 1 + std::numeric_limits<T>::epsilon();
  EXPECT_EQ(multiply_add(x, x, -(x * x)), T(0));
}

TYPED_TEST(Scalar, RoundingUnitIsHalfAStepAboveOne) {
  using T = TypeParam;
  const T one = 1;
  EXPECT_EQ(one + rounding_unit<T>, one);  // a tie, to even
  EXPECT_GT(one + rounding_unit<T> * (1 + std::numeric_limits<T>::epsilon()), one);
}

TYPED_TEST(Scalar, SelectTakesTheChosenValueUnchanged) {
  using T = TypeParam;
  EXPECT_TRUE(std::signbit(select(true, -T(0), T(0))));
  EXPECT_FALSE(std::signbit(select(false, -T(0), T(0))));
  // What is not chosen does not matter, NaN included: kernels compute both sides.
  EXPECT_EQ(select(true, T(3), this->not_a_number), T(3));
  EXPECT_EQ(select(false, this->not_a_number, T(3)), T(3));
}

TYPED_TEST(Scalar, MinAndMaxGiveTheSecondArgumentForNanAndForEqualZeros) {
  using T = TypeParam;
  const T nan = this->not_a_number;
  EXPECT_EQ(min(nan, T(1)), T(1));
  EXPECT_EQ(max(nan, T(1)), T(1));
  EXPECT_TRUE(std::isnan(min(T(1), nan)));
  EXPECT_TRUE(std::isnan(max(T(1), nan)));
  EXPECT_TRUE(std::signbit(min(T(0), -T(0))));
  EXPECT_FALSE(std::signbit(min(-T(0), T(0))));
  EXPECT_TRUE(std::signbit(max(T(0), -T(0))));
  EXPECT_FALSE(std::signbit(max(-T(0), T(0))));
  EXPECT_EQ(min(-this->infinity, T(1)), -this->infinity);
  EXPECT_EQ(max(-this->infinity, T(1)), T(1));
}

TYPED_TEST(Scalar, ClampOrdersItsBoundsAndMakesNanTheLowerOne) {
  using T = TypeParam;
  EXPECT_EQ(clamp(T(-1), T(0), T(2)), T(0));
  EXPECT_EQ(clamp(T(1), T(0), T(2)), T(1));
  EXPECT_EQ(clamp(T(3), T(0), T(2)), T(2));
  EXPECT_EQ(clamp(this->infinity, T(0), T(2)), T(2));
  EXPECT_EQ(clamp(-this->infinity, T(0), T(2)), T(0));
  EXPECT_EQ(clamp(this->not_a_number, T(0), T(2)), T(0));
}

TYPED_TEST(Scalar, ElementaryFunctionsKeepTheirType) {
  using T = TypeParam;
  const T x = T(0.7);
  static_assert(std::is_same_v<decltype(exp(x)), T> && std::is_same_v<decltype(log(x)), T>);
  static_assert(std::is_same_v<decltype(log1p(x)), T> && std::is_same_v<decltype(sqrt(x)), T>);
  static_assert(std::is_same_v<decltype(floor(x)), T> && std::is_same_v<decltype(abs(x)), T>);
  static_assert(std::is_same_v<decltype(fma(x, x, x)), T>);
  static_assert(std::is_same_v<decltype(copysign(x, x)), T>);
  EXPECT_EQ(exp(T(0)), T(1));
  EXPECT_EQ(exp(-this->infinity), T(0));
  EXPECT_EQ(exp(T(1000)), this->infinity);
  EXPECT_EQ(log(T(0)), -this->infinity);
  EXPECT_EQ(log1p(T(-1)), -this->infinity);
  EXPECT_EQ(log1p(std::numeric_limits<T>::denorm_min()), std::numeric_limits<T>::denorm_min());
  EXPECT_EQ(sqrt(T(2.25)), T(1.5));
  EXPECT_EQ(floor(T(-0.5)), T(-1));
  EXPECT_EQ(abs(T(-0.25)), T(0.25));
  EXPECT_FALSE(std::signbit(abs(-T(0))));
}

TYPED_TEST(Scalar, CopysignCountsTheSignOfZero) {
  using T = TypeParam;
  EXPECT_EQ(copysign(T(2), -T(0)), T(-2));
  EXPECT_EQ(copysign(T(-2), T(0)), T(2));
  EXPECT_TRUE(std::signbit(copysign(T(0), T(-1))));
}

TYPED_TEST(Scalar, FmaRoundsOnce) {
  using T = TypeParam;
  const T x = 1 + std::numeric_limits<T>::epsilon();
  const T square = x * x;
  const T lost = std::numeric_limits<T>::epsilon() * std::numeric_limits<T>::epsilon();
  EXPECT_EQ(fma(x, x, -square), lost);  // 0 for a product rounded before the sum
}

TYPED_TEST(Scalar, NanIsSeenAndInfinityIsNot) {
  EXPECT_TRUE(is_nan(this->not_a_number));
  EXPECT_TRUE(is_nan(-this->not_a_number));
  EXPECT_FALSE(is_nan(this->infinity));
  EXPECT_FALSE(is_nan(TypeParam(0)));
}

/// Products and sums are rounded apart: the exactness of kernels (Dekker's splitting) and the
/// equality of pictures between instruction sets rest on it.
TYPED_TEST(Scalar, TheCompilerDoesNotContract) {
  using T = TypeParam;
  volatile T x = 1 + std::numeric_limits<T>::epsilon();
  const T a = x, square = a * a;
  EXPECT_EQ(a * a - square, T(0));
}

}  // namespace
}  // namespace pellucid
