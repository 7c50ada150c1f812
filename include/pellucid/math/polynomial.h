// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "pellucid/simd/scalar.h"

namespace pellucid {

/// c[0] + c[1] s + … by Horner's rule. Rounded separately: on x86-64 without FMA instructions a
/// fused product is a library call that costs more than the whole polynomial, and the errors stated
/// by the callers hold for either.
template <class T, std::size_t Count>
PELLUCID_HD inline T horner(const scalar_t<T> (&c)[Count], T s) noexcept {
  T sum = T(c[Count - 1]);
  for (std::size_t k = Count - 1; k-- > 0;) {
    sum = sum * s + T(c[k]);
  }
  return sum;
}

/// A function of t in [0, 1] by one polynomial per interval of `Intervals` equal ones, each in
/// s = 2 Intervals t - (2 i + 1), which runs over [-1, 1] on interval i. The product is exact where
/// Intervals is a power of two. t outside of [0, 1] uses the nearest interval; NaN gives NaN.
template <class T, std::size_t Intervals, std::size_t Count>
PELLUCID_HD inline T interval_polynomial(const scalar_t<T> (&c)[Intervals][Count], T t) noexcept {
  if constexpr (Intervals == 1) {
    return horner(c[0], T(2) * t - T(1));
  } else {
    constexpr scalar_t<T> last = static_cast<scalar_t<T>>(Intervals - 1);
    // The bounds come before the conversion, which is undefined for NaN and large numbers.
    const auto i = static_cast<int>(clamp(T(Intervals) * t, T(0), T(last)));
    return horner(c[i], T(2 * Intervals) * t - T(2 * i + 1));
  }
}

}  // namespace pellucid
