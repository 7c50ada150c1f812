// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/polynomial.h"
#include "pellucid/math/w0_minus.h"

namespace pellucid {

/// Returns Dawson's function Daw(x) = e^(-x²) ∫ e^(y²) dy over [0, x], odd, at most 0.5411, ~ 1 /
/// (2 x).
///
/// For |x| < 1/2: x Σ (-2 x²)^k / (2 k + 1)!! (specification, 4.3, which stops at 1/4; in between
/// W0- would cost 12 u, because the rounding of t is amplified near the zero of W0-). Beyond,
/// ±W0-(t) t / 2 with t = 2 / (|x| + 2). Daw(±0) = ±0, Daw(±∞) = ±0.
///
/// Largest relative error 7.2 u (float), 7.4 u (double), absolute 3 u, 3 u, for all x whose result
/// is normal; asserted in tests/math/dawson.cpp.
template <class T>
PELLUCID_HD inline T dawson(T x) noexcept {
  const T magnitude = abs(x);
  const auto near = magnitude < T(0.5);
  T result = x;
  if (any(near)) {
    const T y = T(-2) * (x * x);
    // The rest of the series is below 0.07 u at |x| = 1/2.
    if constexpr (is_single<T>) {
      static constexpr float c[] = {
          1.0f,          1.0f / 3.0f,     1.0f / 15.0f,     1.0f / 105.0f,
          1.0f / 945.0f, 1.0f / 10395.0f, 1.0f / 135135.0f, 1.0f / 2027025.0f};
      result = x * horner<T>(c, y);
    } else {
      static constexpr double c[] = {1.0,
                                     1.0 / 3.0,
                                     1.0 / 15.0,
                                     1.0 / 105.0,
                                     1.0 / 945.0,
                                     1.0 / 10395.0,
                                     1.0 / 135135.0,
                                     1.0 / 2027025.0,
                                     1.0 / 34459425.0,
                                     1.0 / 654729075.0,
                                     1.0 / 13749310575.0,
                                     1.0 / 316234143225.0,
                                     1.0 / 7905853580625.0};
      result = x * horner<T>(c, y);
    }
  }
  if (!all(near)) {
    const T t = T(2) / (magnitude + T(2));
    const T far = w0_minus(t) * (T(0.5) * t);
    result = select(near, result, copysign(far, x));
  }
  return result;
}

}  // namespace pellucid
