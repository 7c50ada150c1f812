// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "pellucid/simd/scalar.h"

namespace pellucid {

/// Returns c[0] + c[1] s + … by Horner's rule. The errors stated by the callers hold for fused and
/// for separately rounded products (multiply_add).
template <class T, std::size_t Count>
PELLUCID_HD inline T horner(const scalar_t<T> (&c)[Count], T s) noexcept {
  T sum = T(c[Count - 1]);
  for (std::size_t k = Count - 1; k-- > 0;) {
    sum = multiply_add(sum, s, T(c[k]));
  }
  return sum;
}

/// A table of polynomials with the coefficients of one power next to each other, for look-up by
/// batches.
template <class S, std::size_t Intervals, std::size_t Count>
struct TransposedCoefficients {
  alignas(64) S c[Count][Intervals];
};
/// Returns the transposed table.
template <class S, std::size_t Intervals, std::size_t Count>
consteval TransposedCoefficients<S, Intervals, Count> transposed(
    const S (&c)[Intervals][Count]) noexcept {
  TransposedCoefficients<S, Intervals, Count> result{};
  for (std::size_t i = 0; i < Intervals; ++i) {
    for (std::size_t k = 0; k < Count; ++k) result.c[k][i] = c[i][k];
  }
  return result;
}

namespace detail {

/// One of the equal parts of [0, 1], and the position in it.
template <class T>
struct IntervalPlace {
  index_t<T> interval;
  T s;
};
template <class T, std::size_t Intervals>
PELLUCID_HD inline IntervalPlace<T> interval_place(T t) noexcept {
  constexpr scalar_t<T> last = static_cast<scalar_t<T>>(Intervals - 1);
  // The bounds come before the conversion, which is undefined for NaN and large numbers.
  const auto i = convert<std::int32_t>(clamp(T(Intervals) * t, T(0), T(last)));
  return {i, T(2 * Intervals) * t - convert<scalar_t<T>>(i + i + index_t<T>(1))};
}

}  // namespace detail

/// Returns a function of t in [0, 1] by one polynomial on each of `Intervals` equal intervals, in s
/// = 2 Intervals t - (2 i + 1), which runs over [-1, 1] on interval i. The product is exact if
/// Intervals is a power of two. t outside of [0, 1] uses the nearest interval; NaN gives NaN.
template <class T, std::size_t Intervals, std::size_t Count>
PELLUCID_HD inline T interval_polynomial(const scalar_t<T> (&c)[Intervals][Count], T t) noexcept {
  if constexpr (Intervals == 1) {
    return horner(c[0], T(2) * t - T(1));
  } else {
    static_assert(lanes<T> == 1, "batches also want the table transposed");
    const auto place = detail::interval_place<T, Intervals>(t);
    return horner(c[place.interval], place.s);
  }
}

/// Returns the same, also for batches with different intervals per lane; takes c itself, and c
/// transposed.
template <class T, std::size_t Intervals, std::size_t Count>
PELLUCID_HD inline T interval_polynomial(
    [[maybe_unused]] const scalar_t<T> (&c)[Intervals][Count],
    [[maybe_unused]] const TransposedCoefficients<scalar_t<T>, Intervals, Count>& by_coefficient,
    T t) noexcept {
  if constexpr (lanes<T> == 1) {
    return interval_polynomial<T>(c, t);
  } else {
    const auto place = detail::interval_place<T, Intervals>(t);
    T sum = lookup(by_coefficient.c[Count - 1], place.interval);
    for (std::size_t k = Count - 1; k-- > 0;) {
      sum = multiply_add(sum, place.s, lookup(by_coefficient.c[k], place.interval));
    }
    return sum;
  }
}

}  // namespace pellucid
