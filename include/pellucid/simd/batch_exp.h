// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/batch_number.h"

#if PELLUCID_HAS_BATCH_4
namespace pellucid {

namespace detail {

/// Returns (e^r - 1 - r) / r² for |r| <= ln 2 / 2: minimax for the error that it makes in e^r,
/// relative, 0.07 u (float), 0.1 u (double) with the coefficients rounded.
template <int N>
PELLUCID_ALWAYS_INLINE Batch<float, N> exp_remainder(Batch<float, N> r,
                                                     Batch<float, N> r_squared) noexcept {
  using T = Batch<float, N>;
  const T low = multiply_add(T(0.166665211f), r, T(0.49999994f));
  const T high = multiply_add(T(0.00836872682f), r, T(0.041668389f));
  return multiply_add(multiply_add(T(0.00138145732f), r_squared, high), r_squared, low);
}
template <int N>
PELLUCID_ALWAYS_INLINE Batch<double, N> exp_remainder(Batch<double, N> r,
                                                      Batch<double, N> r_squared) noexcept {
  using T = Batch<double, N>;
  const T c0 = multiply_add(T(0.16666666666666413), r, T(0.50000000000000111));
  const T c2 = multiply_add(T(0.0083333333334946313), r, T(0.041666666666530003));
  const T c4 = multiply_add(T(0.00019841269506317289), r, T(0.0013888888943676689));
  const T c6 = multiply_add(T(2.7557586508325085e-6), r, T(2.4801493045254447e-5));
  const T c8 = multiply_add(T(2.5000051246728901e-8), r, T(2.76302692201019e-7));
  const T high = multiply_add(multiply_add(c8, r_squared, c6), r_squared, c4);
  return multiply_add(multiply_add(high, r_squared, c2), r_squared, c0);
}

/// x = n ln 2 + r: n ln 2 in two parts, the first so short that its product is exact.
template <class S>
struct ExpReduction;
template <>
struct ExpReduction<float> {
  static constexpr float lowest = -104.0f, highest = 89.0f;
  static constexpr float per_log_2 = 1.44269504f;
  static constexpr float log_2_high = 0x1.62e4p-1f, log_2_low = 1.42860682e-6f;
};
template <>
struct ExpReduction<double> {
  static constexpr double lowest = -746.0, highest = 710.0;
  static constexpr double per_log_2 = 1.4426950408889634;
  static constexpr double log_2_high = 0x1.62e42feep-1, log_2_low = 1.9082149292705878e-10;
};

}  // namespace detail

/// Returns e^x = 2^n e^r, |r| <= ln 2 / 2, with e^r = 1 + r + r² P(r) summed so that only the last
/// addition rounds by more than a tenth of u. e^-∞ = 0, e^∞ = ∞, NaN gives NaN.
///
/// Largest relative error 1.1 u where the result is normal; half a denormal step more where it is
/// not (nothing is flushed to zero). Asserted in tests/simd for every width.
template <class T, int N>
PELLUCID_ALWAYS_INLINE Batch<T, N> exp(Batch<T, N> x) noexcept {
  using B = Batch<T, N>;
  using R = detail::ExpReduction<T>;
  // Beyond the bounds the result is 0 or infinite; they let NaN through.
  const B bounded = min(B(R::highest), max(B(R::lowest), x));
  const B n = round_to_nearest(bounded * B(R::per_log_2));
  const B high = bounded - n * B(R::log_2_high);  // exact
  const B low = n * B(R::log_2_low);
  const B r = high - low;
  const B r_squared = r * r;
  // 1 + high rounded, and exactly what that left out.
  const B sum = B(T(1)) + high;
  const B left_out = (B(T(1)) - sum) + high;
  const B rest = multiply_add(r_squared, detail::exp_remainder(r, r_squared), left_out - low);
  return scale_by_power_of_two(sum + rest, n);
}

/// Returns log(1 + x) lane by lane, by the library's function: for what is not worth a kernel of
/// its own.
template <class T, int N>
PELLUCID_ALWAYS_INLINE Batch<T, N> log1p(Batch<T, N> x) noexcept {
  T lane[N];
  x.store(lane);
  for (T& value : lane) value = log1p(value);
  return Batch<T, N>::load(lane);
}
template <class T, int N>
PELLUCID_ALWAYS_INLINE Batch<T, N> log(Batch<T, N> x) noexcept {
  T lane[N];
  x.store(lane);
  for (T& value : lane) value = log(value);
  return Batch<T, N>::load(lane);
}

}  // namespace pellucid
#endif
