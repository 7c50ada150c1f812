// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>

/// Truth for the special functions at 60 digits, by series and continued fractions that share
/// nothing with the code under test: no fitted coefficients, no libm.
namespace pellucid::test {

using Wide = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<60>,
                                           boost::multiprecision::et_off>;

inline Wide wide_sqrt_pi() {
  static const Wide value = sqrt(4 * atan(Wide(1)));
  return value;
}

/// The asymptotic series sum_{k>=first} (2k-1)!! (sign / (2 x²))^k up to its smallest term, which
/// is below e^-144 = 3e-63 for x >= 12.
inline Wide wide_asymptotic(const Wide& x, int sign, int first) {
  const Wide factor = sign / (2 * x * x);
  Wide term = 1;
  Wide sum = first == 0 ? Wide(1) : Wide(0);
  for (int k = 1; k <= 144 && abs(term) > 1e-70; ++k) {
    term *= (2 * k - 1) * factor;
    if (k >= first) {
      sum += term;
    }
  }
  return sum;
}

/// e^(x²) erfc(x), x >= 0: for small x from the series of erf, whose cancellation costs less than
/// 20 of the 60 digits; then by the continued fraction of Laplace; then asymptotically.
inline Wide wide_erfcx(const Wide& x) {
  if (x >= 12) {
    return wide_asymptotic(x, -1, 0) / (x * wide_sqrt_pi());
  }
  if (x >= 5) {
    Wide tail = x;
    for (int k = 200; k >= 1; --k) {
      tail = x + Wide(k) / 2 / tail;
    }
    return 1 / (tail * wide_sqrt_pi());
  }
  Wide term = x;
  Wide sum = x;
  for (int k = 1; term > 1e-60; ++k) {
    term *= 2 * x * x / (2 * k + 1);
    sum += term;
  }
  return exp(x * x) - 2 * sum / wide_sqrt_pi();
}

inline Wide wide_erfc(const Wide& x) {
  return x < 0 ? 2 - exp(-x * x) * wide_erfcx(-x) : exp(-x * x) * wide_erfcx(x);
}

/// Positive terms only: no cancellation for small x.
inline Wide wide_erf(const Wide& x) {
  if (abs(x) > 2) {
    return x < 0 ? wide_erfc(-x) - 1 : 1 - wide_erfc(x);
  }
  Wide term = x;
  Wide sum = x;
  for (int k = 1; abs(term) > 1e-60 * abs(x); ++k) {
    term *= 2 * x * x / (2 * k + 1);
    sum += term;
  }
  return 2 * exp(-x * x) * sum / wide_sqrt_pi();
}

/// e^(-x²) times the integral of e^(y²) from 0 to x, whose series has positive terms only.
inline Wide wide_dawson(const Wide& x) {
  if (abs(x) >= 12) {
    return wide_asymptotic(x, +1, 0) / (2 * x);
  }
  Wide power = x;
  Wide sum = x;
  for (int k = 1; abs(power) > 1e-62 * abs(x); ++k) {
    power *= x * x / k;
    sum += power / (2 * k + 1);
  }
  return exp(-x * x) * sum;
}

/// (1 - e^(-x)) / x, 1 at 0: by its series where the quotient would cancel.
inline Wide wide_expm1_quotient(const Wide& x) {
  if (abs(x) > 1) {
    return (1 - exp(-x)) / x;
  }
  Wide term = 1;
  Wide sum = 1;
  for (int k = 2; abs(term) > 1e-62; ++k) {
    term *= -x / k;
    sum += term;
  }
  return sum;
}

/// d/dx of the above: -sum_{k>=0} (-x)^k / (k! (k + 2)).
inline Wide wide_expm1_quotient_derivative(const Wide& x) {
  if (abs(x) > 1) {
    return (exp(-x) * (1 + x) - 1) / (x * x);
  }
  Wide power = 1;
  Wide sum = Wide(1) / 2;
  for (int k = 1; abs(power) > 1e-62; ++k) {
    power *= -x / k;
    sum += power / (k + 2);
  }
  return -sum;
}

/// The scaled tails of math/scaled_tail.h from their definitions, δ = 2 (1 - t) / t.
struct WideTails {
  Wide w0_plus, w0_minus, w1_plus, w1_minus;
};
inline WideTails wide_scaled_tails(const Wide& t) {
  if (t == 0) {
    return {Wide(1) / 2, Wide(1) / 2, Wide(1) / 4, Wide(1) / 4};
  }
  const Wide delta = 2 * (1 - t) / t;
  const Wide scale = delta + 2;
  const Wide decaying = wide_erfcx(delta) * wide_sqrt_pi();
  const Wide growing = wide_dawson(delta);
  // The brackets of W1 tend to 1 / (2 δ²): subtracting the 1 is left out of the series there.
  const bool far = delta >= 12;
  const Wide plus = far ? -wide_asymptotic(delta, -1, 1) : 1 - delta * decaying;
  const Wide minus = far ? wide_asymptotic(delta, +1, 1) : 2 * delta * growing - 1;
  return {scale * decaying / 2, scale * growing, scale * scale * plus / 2,
          scale * scale * minus / 2};
}

}  // namespace pellucid::test
