// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/erf_over_x.h"
#include "pellucid/math/exponential.h"
#include "pellucid/math/w0_plus.h"

/// erf, erfc and erfcx (specification, 4.3), written so that every lane of a batch executes the
/// same steps. exp is the only library function that they need; the stated errors are for an exp
/// within 1.1 u.
namespace pellucid {

/// Returns erfcx(x) = e^(x²) erfc(x) for x >= 0, where it decreases from 1 to 1 / (√π x): nothing
/// underflows until x itself is near the largest number. W0+(t) t / √π, t = 2 / (x + 2).
///
/// Largest relative error 6.2 u (float), 5.6 u (double) for x in [0, ∞] whose result is normal,
/// asserted in tests/math/error_function.cpp. Not valid for x < 0 (see erfcx()).
template <class T>
PELLUCID_HD inline T erfcx_nonnegative(T x) noexcept {
  const T t = T(2) / (x + T(2));
  return w0_plus(t) * t * T(one_over_sqrt_pi<T>);
}

/// Returns erf(x) = (2/√π) ∫ e^(-y²) dy over [0, x]. For |x| < 1: x times a polynomial in x²;
/// beyond, ±(1 - e^(-x²) erfcx(|x|)). erf(±0) = ±0, erf(±∞) = ±1.
///
/// Largest relative error 2.8 u (float), 2.8 u (double) for all x, asserted in
/// tests/math/error_function.cpp. Never take a difference of two erf: see segment/gaussian.h.
template <class T>
PELLUCID_HD inline T erf(T x) noexcept {
  const T magnitude = abs(x);
  const auto near = magnitude < T(1);
  T result = x;
  if (any(near)) {
    result = x * erf_over_x(x * x);
  }
  if (!all(near)) {
    const T far = T(1) - exp_minus_square(magnitude) * erfcx_nonnegative(magnitude);
    result = select(near, result, copysign(far, x));
  }
  return result;
}

/// Returns erfc(x) = 1 - erf(x). For |x| < 1/2: that difference, which is above 0.47; beyond,
/// e^(-x²) erfcx(|x|) with the square compensated, and 2 minus that for x < 0.
///
/// Largest relative error 7.2 u (float), 7 u (double) for all x whose result is normal (x < 9.19,
/// 26.5), one denormal step more otherwise; asserted in tests/math/error_function.cpp.
template <class T>
PELLUCID_HD inline T erfc(T x) noexcept {
  const T magnitude = abs(x);
  const auto near = magnitude < T(0.5);
  T result = x;
  if (any(near)) {
    result = T(1) - x * erf_over_x(x * x);
  }
  if (!all(near)) {
    const T tail = exp_minus_square(magnitude) * erfcx_nonnegative(magnitude);
    result = select(near, result, select(x < T(0), T(2) - tail, tail));
  }
  return result;
}

/// Returns erfcx(x) = e^(x²) erfc(x) for every x. For x < 0 it is that product of a number from 1
/// to 2 and a growing factor, which overflows to +infinity below -9.382 (float), -26.628 (double).
///
/// Largest relative error 6.2 u (float), 5.6 u (double) if finite and normal, asserted in
/// tests/math/error_function.cpp.
template <class T>
PELLUCID_HD inline T erfcx(T x) noexcept {
  const T decaying = erfcx_nonnegative(abs(x));
  const auto negative = x < T(0);
  if (!any(negative)) {
    return decaying;
  }
  return select(negative, exp_square(x) * erfc(x), decaying);
}

}  // namespace pellucid
