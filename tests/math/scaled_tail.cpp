// SPDX-License-Identifier: Apache-2.0
#include "pellucid/math/scaled_tail.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "tests/math/sweep.h"

namespace pellucid::test {
namespace {

/// [0, 1], with both sides of every seam between two polynomials.
template <class T>
std::vector<T> scaled_arguments() {
  std::vector<T> seams;
  for (int i = 1; i < 16; ++i) {
    seams.push_back(T(i) / 16);
  }
  std::vector<T> all = arguments<T>(T(0), T(1), seams, 3000);
  all.push_back(std::numeric_limits<T>::denorm_min());
  return all;
}

/// The largest absolute errors stated in math/scaled_tail.h.
template <class T>
void errors_are_as_stated(const char* type, long double w0_plus_bound, long double w0_minus_bound,
                          long double w1_plus_bound, long double w1_minus_bound) {
  ErrorRecord plus0(std::string("w0_plus, ") + type), minus0(std::string("w0_minus, ") + type);
  ErrorRecord plus1(std::string("w1_plus, ") + type), minus1(std::string("w1_minus, ") + type);
  for (const T t : scaled_arguments<T>()) {
    const WideTails truth = wide_scaled_tails(Wide(t));
    const auto where = [t] { return at(t); };
    plus0.add(absolute_error_in_u(w0_plus(t), static_cast<long double>(truth.w0_plus)), where);
    minus0.add(absolute_error_in_u(w0_minus(t), static_cast<long double>(truth.w0_minus)), where);
    plus1.add(absolute_error_in_u(w1_plus(t), static_cast<long double>(truth.w1_plus)), where);
    minus1.add(absolute_error_in_u(w1_minus(t), static_cast<long double>(truth.w1_minus)), where);
  }
  for (const ErrorRecord& record : {plus0, minus0, plus1, minus1}) {
    record.print();
  }
  EXPECT_LE(plus0.largest(), w0_plus_bound);
  EXPECT_LE(minus0.largest(), w0_minus_bound);
  EXPECT_LE(plus1.largest(), w1_plus_bound);
  EXPECT_LE(minus1.largest(), w1_minus_bound);
}

TEST(ScaledTail, ErrorsAreAsStatedInFloat) {
  errors_are_as_stated<float>("float", 2.6L, 2.2L, 2.8L, 4.0L);
}

TEST(ScaledTail, ErrorsAreAsStatedInDouble) {
  errors_are_as_stated<double>("double", 2.2L, 2.0L, 2.2L, 4.4L);
}

template <class T>
void ends_and_exceptions() {
  const T u = std::numeric_limits<T>::epsilon();
  EXPECT_NEAR(w0_plus(T(0)), 0.5, u);
  EXPECT_NEAR(w0_minus(T(0)), 0.5, u);
  EXPECT_NEAR(w1_plus(T(0)), 0.25, u);
  EXPECT_NEAR(w1_minus(T(0)), 0.25, u);
  EXPECT_NEAR(w0_plus(T(1)), 1.7724538509055160273, 2 * u);
  EXPECT_NEAR(w0_minus(T(1)), 0, 2 * u);
  EXPECT_NEAR(w1_plus(T(1)), 2, 2 * u);
  EXPECT_NEAR(w1_minus(T(1)), -2, 2 * u);
  const T nan = std::numeric_limits<T>::quiet_NaN();
  EXPECT_TRUE(std::isnan(w0_plus(nan)));
  EXPECT_TRUE(std::isnan(w0_minus(nan)));
  EXPECT_TRUE(std::isnan(w1_plus(nan)));
  EXPECT_TRUE(std::isnan(w1_minus(nan)));
}

TEST(ScaledTail, EndsAndNan) {
  ends_and_exceptions<float>();
  ends_and_exceptions<double>();
}

}  // namespace
}  // namespace pellucid::test
