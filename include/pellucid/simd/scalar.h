// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
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
struct MaskOf {
  using type = bool;
};
template <class T>
struct IndexOf {
  using type = int;
};
template <class T>
struct InFloat {
  using type = float;
};

/// Type of the comparison of two T.
template <class T>
using mask_t = typename MaskOf<T>::type;

/// One int per lane of T: what gather() and load_records() take.
template <class T>
using index_t = typename IndexOf<T>::type;
/// One float per lane of T.
template <class T>
using in_float_t = typename InFloat<T>::type;

/// Number of lanes of a T.
template <class T>
inline constexpr int lanes = 1;

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
PELLUCID_HD constexpr bool none(bool mask) noexcept {
  return !mask;
}
PELLUCID_HD constexpr int count(bool mask) noexcept {
  return mask ? 1 : 0;
}
/// Returns one bit per lane, lane 0 the lowest.
PELLUCID_HD constexpr unsigned bits(bool mask) noexcept {
  return mask ? 1u : 0u;
}
/// Assigns the value in lanes of the mask only.
template <class T>
PELLUCID_HD constexpr void assign(bool mask, T& target, T value) noexcept {
  if (mask) target = value;
}

/// Converts like static_cast: to int towards zero, from double to float to the nearest.
template <class To, class From>
requires std::is_arithmetic_v<From> PELLUCID_HD constexpr To convert(From x) noexcept {
  return static_cast<To>(x);
}

template <class T>
PELLUCID_HD constexpr T gather(const T* base, int index) noexcept {
  return base[index];
}
/// Returns gather() of a table that is small enough to be held in registers.
template <class T, std::size_t Entries>
PELLUCID_HD constexpr T lookup(const T (&table)[Entries], int index) noexcept {
  return table[index];
}
/// True if lookup() of 16 numbers takes less than a load for each lane.
template <class T>
inline constexpr bool looks_up_in_registers = false;

/// Sets out[k] = base[K index + k], k < K.
template <int K>
PELLUCID_HD constexpr void load_records(const float* base, int index, float* out) noexcept {
  for (int k = 0; k < K; ++k) out[k] = base[K * static_cast<std::ptrdiff_t>(index) + k];
}

template <int K>
PELLUCID_HD constexpr void load_records(const double* base, int index, double* out) noexcept {
  for (int k = 0; k < K; ++k) out[k] = base[K * static_cast<std::ptrdiff_t>(index) + k];
}

template <int K>
PELLUCID_HD constexpr void load_records(const std::int32_t* base, int index, int* out) noexcept {
  for (int k = 0; k < K; ++k) out[k] = base[K * static_cast<std::ptrdiff_t>(index) + k];
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

/// Returns a b + c with one rounding, also where the machine has no such instruction.
PELLUCID_HD inline float fma(float a, float b, float c) noexcept {
  return std::fma(a, b, c);
}
PELLUCID_HD inline double fma(double a, double b, double c) noexcept {
  return std::fma(a, b, c);
}

/// Returns a b + c, rounded once or twice, whichever is faster: for sums whose stated error holds
/// for either. At width 1 twice: on x86-64 without FMA instructions a fused product is a library
/// call.
PELLUCID_HD constexpr float multiply_add(float a, float b, float c) noexcept {
  return a * b + c;
}
PELLUCID_HD constexpr double multiply_add(double a, double b, double c) noexcept {
  return a * b + c;
}

/// True if multiply_add(a, b, c) is fused: one rounding.
template <class T>
inline constexpr bool fuses = false;

/// Returns the smaller one; b where either argument is NaN, like the machine instruction.
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

/// Returns x with the sign of s; s = ±0 counts with its sign bit.
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
