// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/constants.h"
#include "pellucid/math/polynomial.h"

/// Functions of e^x for the volume rendering integral whose direct forms would cancel or lose
/// digits. The stated errors are for an exp within 1.1 u (glibc's and that of batches, but not
/// CUDA's).
namespace pellucid {

/// Returns sinh(h) / h as a function of y = h² in [0, 1]: b_0 of the specification (9). Its Taylor
/// series, truncated where the remainder is below 0.07 u.
template <class T>
PELLUCID_HD inline T sinh_over_x(T y) noexcept {
  if constexpr (is_single<T>) {
    static constexpr float c[] = {1.0f,           1.0f / 6.0f,      1.0f / 120.0f,
                                  1.0f / 5040.0f, 1.0f / 362880.0f, 1.0f / 39916800.0f};
    return horner<T>(c, y);
  } else {
    static constexpr double c[] = {1.0,
                                   1.0 / 6.0,
                                   1.0 / 120.0,
                                   1.0 / 5040.0,
                                   1.0 / 362880.0,
                                   1.0 / 39916800.0,
                                   1.0 / 6227020800.0,
                                   1.0 / 1307674368000.0,
                                   1.0 / 355687428096000.0};
    return horner<T>(c, y);
  }
}

/// Returns (cosh(h) - sinh(h) / h) / h² as a function of y = h² in [0, 1]: b_1 of the specification
/// (9), with the coefficients (2 j + 2) / (2 j + 3)!.
template <class T>
PELLUCID_HD inline T cosh_minus_sinh_over_x(T y) noexcept {
  if constexpr (is_single<T>) {
    static constexpr float c[] = {1.0f / 3.0f,     1.0f / 30.0f,      1.0f / 840.0f,
                                  1.0f / 45360.0f, 1.0f / 3991680.0f, 1.0f / 518918400.0f};
    return horner<T>(c, y);
  } else {
    static constexpr double c[] = {1.0 / 3.0,
                                   1.0 / 30.0,
                                   1.0 / 840.0,
                                   1.0 / 45360.0,
                                   1.0 / 3991680.0,
                                   1.0 / 518918400.0,
                                   1.0 / 93405312000.0,
                                   1.0 / 22230464256000.0,
                                   1.0 / 6758061133824000.0};
    return horner<T>(c, y);
  }
}

/// Returns φ₁(x) = (1 - e^(-x)) / x, 1 at 0: the mean transparency of a segment of optical depth x
/// with constant extinction (specification, 4.1). For |x| <= 2 it is e^(-x/2) sinh(x/2) / (x/2), a
/// series of positive terms where the quotient would lose all digits; beyond, the quotient.
///
/// Largest relative error 3.3 u (float), 3.3 u (double) for every x whose e^(-x) does not overflow
/// (x > -88, x > -709); below, +infinity. φ₁(+∞) = 0. Asserted in tests/math/exponential.cpp.
template <class T>
PELLUCID_HD inline T expm1_quotient(T x) noexcept {
  const T half = T(0.5) * x;
  const auto far = abs(x) > T(2);
  const T e = exp(-select(far, x, half));
  const T series = e * sinh_over_x<T>(half * half);
  if (!any(far)) {
    return series;
  }
  // The bound keeps -∞ from being divided by itself; a NaN goes through.
  return select(far, (T(1) - e) / max(T(-largest<T>), x), series);
}

/// Returns φ₁'(x) = -∫ u e^(-u x) du over [0, 1], -1/2 at 0 (specification, 4.1): -½ e^(-h) (b_0 -
/// h b_1), h = x / 2, for |x| <= 2, where ((1 + x) e^(-x) - 1) / x² would cancel; that quotient
/// beyond.
///
/// Largest relative error 4.2 u (float), 4.2 u (double) until (1 + x) e^(-x) overflows (x > -84, x
/// > -702); below, -infinity. φ₁'(+∞) = -0. Asserted in tests/math/exponential.cpp.
template <class T>
PELLUCID_HD inline T expm1_quotient_derivative(T x) noexcept {
  const T half = T(0.5) * x;
  const auto far = abs(x) > T(2);
  // e^(-1000) is 0 and e^1000 infinite in both precisions: the bounds keep 0 · ∞ and ∞ / ∞ away.
  const T bounded = max(T(-1000), min(T(1000), x));
  const T e = exp(-select(far, bounded, half));
  const T y = half * half;
  const T series = T(-0.5) * e * (sinh_over_x<T>(y) - half * cosh_minus_sinh_over_x<T>(y));
  if (!any(far)) {
    return series;
  }
  const T numerator = (T(1) + bounded) * e - T(1);
  const T divisor = max(T(-largest<T>), x);
  return select(far, numerator / divisor / divisor, series);
}

/// Returns 1 - e^(-x), the opacity of an optical depth x >= 0 (specification, 3.1). For x <= 2 it
/// is x · φ₁(x); a thin segment keeps all its digits, down to denormal x, and ±0 gives ±0.
///
/// Largest relative error 3.7 u (float), 3.7 u (double) for x >= 0; the result is in [0, 1].
/// Negative x is allowed, with 4 u, until e^(-x) overflows to -infinity. Asserted in
/// tests/math/exponential.cpp.
template <class T>
PELLUCID_HD inline T one_minus_exp_neg(T x) noexcept {
  const T half = T(0.5) * x;
  const auto far = abs(x) > T(2);
  const T e = exp(-select(far, x, half));
  const T series = x * (e * sinh_over_x<T>(half * half));
  if (!any(far)) {
    return series;
  }
  return select(far, T(1) - e, series);
}

/// x² as a rounded product and its rounding error: square + residual = x² exactly, if x² neither
/// overflows nor is so small that the residual is not representable (|x| in [1e-12, 1e15] float,
/// [1e-130, 1e145] double). By Dekker's splitting, because the fused multiply-add is a function
/// call on the x86-64 baseline (3 ns against 1 ns for the whole); fused where it is one
/// instruction.
template <class T>
struct ExactSquare {
  T square, residual;
};
template <class T>
PELLUCID_HD inline ExactSquare<T> exact_square(T x) noexcept {
  const T square = x * x;
  if constexpr (PELLUCID_ON_DEVICE || fuses<T>) {
    return {square, fma(x, x, -square)};
  } else {
    constexpr scalar_t<T> splitter = is_single<T> ? 4097 : 134217729;  // 2^12 + 1, 2^27 + 1
    const T scaled = T(splitter) * x;
    const T high = scaled - (scaled - x);
    const T low = x - high;
    return {square, ((high * high - square) + T(2) * (high * low)) + low * low};
  }
}

/// Returns e^(-x²) (specification, 4.1). The rounding of x² would be amplified to x² u in the
/// result (81 u at x = 9); one factor compensates for it.
///
/// Largest relative error 3.1 u (float), 3.1 u (double) if the result is a normal number (|x| <=
/// 9.34, 26.6), one denormal step more otherwise; 0 beyond, also for ±∞. Asserted in
/// tests/math/exponential.cpp.
template <class T>
PELLUCID_HD inline T exp_minus_square(T x) noexcept {
  const ExactSquare<T> exact = exact_square(min(T(32), abs(x)));  // e^(-32²) is 0
  return exp(-exact.square) * (T(1) - exact.residual);
}

/// Returns e^(x²), compensated likewise.
///
/// Largest relative error 3.1 u (float), 3.1 u (double) until it overflows to infinity at |x| =
/// 9.419 (float), 26.64 (double). Asserted in tests/math/exponential.cpp.
template <class T>
PELLUCID_HD inline T exp_square(T x) noexcept {
  const ExactSquare<T> exact = exact_square(min(T(32), abs(x)));  // e^(32²) is infinite
  return exp(exact.square) * (T(1) + exact.residual);
}

}  // namespace pellucid
