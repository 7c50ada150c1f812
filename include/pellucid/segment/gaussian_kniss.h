// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/segment/gaussian.h"

/// The integral as computed by Kniss et al. 2003, for comparison with segment/gaussian.h, not for
/// pictures. None of its errors is bounded.
namespace pellucid {

/// Returns erf(x) ≈ 1 - (a1 t + a2 t² + a3 t³) e^(-x²), t = 1/(1 + 0.47047 x), x >= 0, odd:
/// Abramowitz & Stegun 7.1.25, Kniss (25). Largest absolute error 2.5e-5, asserted in
/// tests/segment; the relative error for small x is unbounded.
template <class T>
PELLUCID_HD T erf_kniss(T x) noexcept {
  const T y = min(abs(x), T(32));  // e^(-32²) is 0
  const T t = T(1) / (T(1) + T(0.47047) * y);
  const T p = t * (T(0.3480242) + t * (T(-0.0958798) + t * T(0.7478556)));
  return copysign(T(1) - p * exp(-(y * y)), x);
}

/// Returns the mean density by Kniss (12): √π S (erf B - erf A) / (2 |d|), S = e^(A² - |p1|²), with
/// the ends A and B along d. For |d| = 0, where the paper has no value, returns the density there.
/// Clamped to [0, 1], which the formula may leave.
///
/// The error of erf is divided by |d|: up to 5e-5 / |d|, so that no digit is correct in short
/// segments; S cancels far from the center. Measured in tests/segment.
template <class T>
PELLUCID_HD T kniss_mean_density(const T* p1, const T* p2, const T* d, int rows) noexcept {
  T square = T(0), norm = T(0), along_1 = T(0), along_2 = T(0);
  for (int k = 0; k < rows; ++k) {
    square += p1[k] * p1[k];
    norm += d[k] * d[k];
    along_1 += d[k] * p1[k];
    along_2 += d[k] * p2[k];
  }
  const auto is_point = norm <= T(0);
  const T length = sqrt(select(is_point, T(1), norm));
  const T a = along_1 / length, b = along_2 / length;
  const T s = exp(a * a - square);
  const T mean = T(half_sqrt_pi<T>) * s * (erf_kniss(b) - erf_kniss(a)) / length;
  return clamp(select(is_point, exp(-square), mean), T(0), T(1));
}

template <class S, class T>
PELLUCID_HD T kniss_mean_density(const Gaussian<S>& primitive, const T* v1, const T* v2) noexcept {
  T p1[max_channels], p2[max_channels], d[max_channels];
  primitive.transform(v1, p1);
  primitive.transform(v2, p2);
  primitive.displacement(v1, v2, d);
  return kniss_mean_density(p1, p2, d, primitive.rows);
}

}  // namespace pellucid
