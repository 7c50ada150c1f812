// SPDX-License-Identifier: Apache-2.0
#include "pellucid/math/determinant.h"

#include <gtest/gtest.h>

#include "tests/math/determinant_cases.h"

namespace pellucid::test {
namespace {

template <class T>
int sign_of(T x) {
  return (x > 0) - (x < 0);
}

template <class T>
void expect_exact_signs(const char* name) {
  ErrorRecord record(name, "u (|p| + |q|)");
  int uncertain = 0, zero = 0;
  for (const DeterminantCase<T>& c : determinant_cases<T>(40000 * sweep_density())) {
    const T found = determinant(c.a_x, c.a_y, c.b_x, c.b_y);
    ASSERT_EQ(sign_of(found), c.sign()) << c.text();
    ASSERT_EQ(determinant(c.b_x, c.b_y, c.a_x, c.a_y), -found) << c.text();
    record.add(c.error_of(found), [&] { return c.text(); });
    const RoundedDeterminant<T> rounded = rounded_determinant(c.a_x, c.a_y, c.b_x, c.b_y);
    if (rounded.certain) {
      ASSERT_EQ(sign_of(rounded.value), c.sign()) << c.text();
    } else {
      ++uncertain;
    }
    zero += c.sign() == 0 ? 1 : 0;
  }
  record.print();
  EXPECT_LE(record.largest(), 2);
  // The cases are hard ones: in many rounding does not tell, and in fewer there is nothing to tell.
  EXPECT_GT(uncertain, 10000);
  EXPECT_GT(zero, 1000);
  EXPECT_GT(uncertain - zero, 5000);
}
TEST(Determinant, HasTheExactSign) {
  expect_exact_signs<double>("determinant, double");
  expect_exact_signs<float>("determinant, float");
}

/// Veltkamp's split and Dekker's product are exact where the machine does not fuse.
TEST(Determinant, WhatAProductLostIsExact) {
  for (const DeterminantCase<double>& c : determinant_cases<double>(4000)) {
    const double product = c.a_x * c.b_y;
    ASSERT_EQ(ProductOfTwo(product) + detail::product_error(c.a_x, c.b_y, product), c.first())
        << c.text();
  }
}

/// At the limits that are stated.
TEST(Determinant, TakesNumbersAsLargeAsItSays) {
  const double huge = std::nextafter(0x1p500, 0.0), next = std::nextafter(huge, 0.0);
  EXPECT_GT(determinant(huge, next, huge, huge), 0);
  EXPECT_LT(determinant(next, huge, huge, huge), 0);
  EXPECT_EQ(determinant(huge, next, huge, next), 0);
  const double tiny = 0x1p-449, more = std::nextafter(tiny, 1.0);
  EXPECT_GT(determinant(more, tiny, tiny, tiny), 0);
  EXPECT_LT(determinant(tiny, more, tiny, tiny), 0);
}

}  // namespace
}  // namespace pellucid::test
