// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "pellucid/base/config.h"

/// The number types of the kernels at width 1. A kernel is templated on T and written with the
/// names below (`select` instead of a branch on lanes, `any` where skipping pays), so that a batch
/// type with the same names drops in without touching it.
namespace pellucid {

template <class T>
struct ScalarOf {
  using type = T;
};

/// float or double, whatever the width of T. Constants, thresholds and term counts depend on this.
template <class T>
using scalar_t = typename ScalarOf<T>::type;

template <class T>
inline constexpr bool is_single = std::is_same_v<scalar_t<T>, float>;

/// u of the specification: half the distance from 1 to the next larger number.
template <class T>
inline constexpr scalar_t<T> rounding_unit = std::numeric_limits<scalar_t<T>>::epsilon() / 2;

template <class T>
PELLUCID_HD constexpr T select(bool mask, T if_true, T if_false) noexcept {
  return mask ? if_true : if_false;
}
PELLUCID_HD constexpr bool any(bool mask) noexcept {
  return mask;
}
PELLUCID_HD constexpr bool all(bool mask) noexcept {
  return mask;
}

#define PELLUCID_FORWARD_UNARY(name)                  \
  PELLUCID_HD inline float name(float x) noexcept {   \
    return std::name(x);                              \
  }                                                   \
  PELLUCID_HD inline double name(double x) noexcept { \
    return std::name(x);                              \
  }
PELLUCID_FORWARD_UNARY(exp)
PELLUCID_FORWARD_UNARY(log)
PELLUCID_FORWARD_UNARY(log1p)
PELLUCID_FORWARD_UNARY(sqrt)
PELLUCID_FORWARD_UNARY(floor)
PELLUCID_FORWARD_UNARY(abs)
#undef PELLUCID_FORWARD_UNARY

/// Fused: one rounding, also where the machine has no such instruction.
PELLUCID_HD inline float fma(float a, float b, float c) noexcept {
  return std::fma(a, b, c);
}
PELLUCID_HD inline double fma(double a, double b, double c) noexcept {
  return std::fma(a, b, c);
}

/// A NaN in either argument gives b, like the machine instruction.
template <class T>
PELLUCID_HD constexpr T min(T a, T b) noexcept {
  return select(a < b, a, b);
}
template <class T>
PELLUCID_HD constexpr T max(T a, T b) noexcept {
  return select(a > b, a, b);
}
template <class T>
PELLUCID_HD constexpr T clamp(T x, T lo, T hi) noexcept {
  return min(max(x, lo), hi);
}

/// x with the sign of s; s = ±0 counts with its sign bit.
PELLUCID_HD inline float copysign(float x, float s) noexcept {
  return std::copysign(x, s);
}
PELLUCID_HD inline double copysign(double x, double s) noexcept {
  return std::copysign(x, s);
}

PELLUCID_HD inline bool is_nan(float x) noexcept {
  return x != x;
}
PELLUCID_HD inline bool is_nan(double x) noexcept {
  return x != x;
}

}  // namespace pellucid
