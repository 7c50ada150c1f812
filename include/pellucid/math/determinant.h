// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/scalar.h"

namespace pellucid {

namespace detail {

/// Returns a · b - product exactly, where product is a · b rounded (Dekker 1971, with Veltkamp's
/// split; one operation if the machine has a fused multiply-add). Preconditions: |a|, |b| < 2^996,
/// and nothing underflows.
template <class T>
PELLUCID_HD T product_error(T a, T b, T product) noexcept {
  if constexpr (fuses<T>) {
    return multiply_add(a, b, -product);
  } else {
    constexpr scalar_t<T> split = is_single<T> ? scalar_t<T>(4097) : scalar_t<T>(134217729);
    const T s = T(split) * a, a_high = s - (s - a), a_low = a - a_high;
    const T r = T(split) * b, b_high = r - (r - b), b_low = b - b_high;
    return ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
  }
}

}  // namespace detail

/// a_x b_y - a_y b_x with rounding, and whether its sign is certain: the products have an error of
/// u each.
template <class T>
struct RoundedDeterminant {
  T value{};
  T size{};  ///< |a_x b_y| + |a_y b_x|
  mask_t<T> certain = mask_t<T>(false);
};
template <class T>
PELLUCID_HD RoundedDeterminant<T> rounded_determinant(T a_x, T a_y, T b_x, T b_y) noexcept {
  const T p = a_x * b_y, q = a_y * b_x;
  const T difference = p - q, size = abs(p) + abs(q);
  return {difference, size, abs(difference) > T(4 * rounding_unit<T>) * size};
}

/// Returns a_x b_y - a_y b_x, twice the signed area of the triangle (0, a, b). Its sign is exact,
/// and exchanging a and b changes only the sign. Largest error 2 u (|a_x b_y| + |a_y b_x|).
/// Asserted in tests/math. Preconditions: |a|, |b| < 2^500, and no nonzero product below 2^-900 (in
/// double; below it the sign may be 0).
///
/// If the sign of the rounded value is not certain, the rounding errors of the products are added
/// again: the difference of the products is exact there (Sterbenz), and that of their errors is two
/// numbers (Knuth's sum).
template <class T>
PELLUCID_HD T determinant(T a_x, T a_y, T b_x, T b_y) noexcept {
  const RoundedDeterminant<T> rounded = rounded_determinant(a_x, a_y, b_x, b_y);
  if (all(rounded.certain)) return rounded.value;
  const T p = a_x * b_y, q = a_y * b_x;
  const T lost_p = detail::product_error(a_x, b_y, p), lost_q = detail::product_error(a_y, b_x, q);
  const T lost = lost_p - lost_q, back = lost - lost_p;
  const T rest = (lost_p - (lost - back)) - (lost_q + back);
  return select(rounded.certain, rounded.value, (rounded.value + lost) + rest);
}

}  // namespace pellucid
