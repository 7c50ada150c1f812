// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/scalar.h"

/// Constants in the scalar type of T, each the nearest number of that type.
namespace pellucid {

template <class T>
inline constexpr scalar_t<T> pi = scalar_t<T>(3.14159265358979323846L);
template <class T>
inline constexpr scalar_t<T> sqrt_pi = scalar_t<T>(1.77245385090551602730L);
template <class T>
inline constexpr scalar_t<T> half_sqrt_pi = scalar_t<T>(0.88622692545275801365L);
template <class T>
inline constexpr scalar_t<T> one_over_sqrt_pi = scalar_t<T>(0.56418958354775628695L);
template <class T>
inline constexpr scalar_t<T> two_over_sqrt_pi = scalar_t<T>(1.12837916709551257390L);

/// The largest finite number.
template <class T>
inline constexpr scalar_t<T> largest = std::numeric_limits<scalar_t<T>>::max();

/// The smallest number with full precision; divisors that may be zero are kept above it.
template <class T>
inline constexpr scalar_t<T> smallest_normal = std::numeric_limits<scalar_t<T>>::min();

}  // namespace pellucid
