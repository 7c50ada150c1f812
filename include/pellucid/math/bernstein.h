// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/scalar.h"

namespace pellucid {

/// Returns a at t = 0 and b at t = 1, both exactly; equal ends give their value exactly; in between
/// the result never leaves [min(a,b), max(a,b)]. It interpolates from the nearer end, which halves
/// the rounding of b - a. Largest error: 2 u max(|a|,|b|) for finite b - a, t in [0,1].
template <class T>
PELLUCID_HD constexpr T interpolate(T a, T b, T t) noexcept {
  const T d = b - a;
  if constexpr (lanes<T> == 1) {
    return select(t < T(0.5), a + t * d, b - (T(1) - t) * d);
  } else {
    // The same but for fused products, as 1 - t is exact there; one product less.
    const auto near = t < T(0.5);
    return multiply_add(select(near, t, t - T(1)), d, select(near, a, b));
  }
}

/// A cubic on [0,1] by its Bernstein coefficients:
///
///   f(t) = b0 (1-t)³ + 3 b1 t (1-t)² + 3 b2 t² (1-t) + b3 t³
///
/// The values at 0 and 1 are b0 and b3, the mean is that of the coefficients, and f stays within
/// their hull (G. Farin, Curves and Surfaces for CAGD, 5th ed., chapter 5).
template <class T>
struct CubicBernstein {
  T b[4]{};

  PELLUCID_HD constexpr T mean() const noexcept {
    return T(0.25) * ((b[0] + b[3]) + (b[1] + b[2]));
  }
  PELLUCID_HD constexpr T hull_min() const noexcept {
    return min(min(b[0], b[3]), min(b[1], b[2]));
  }
  PELLUCID_HD constexpr T hull_max() const noexcept {
    return max(max(b[0], b[3]), max(b[1], b[2]));
  }
};

/// Returns a lower bound on |f'| over [0,1]; 0 or less, without meaning, if the coefficients are
/// not monotone.
template <class T>
PELLUCID_HD constexpr T least_slope(const CubicBernstein<T>& f) noexcept {
  const T d0 = f.b[1] - f.b[0], d1 = f.b[2] - f.b[1], d2 = f.b[3] - f.b[2];
  return T(3) * max(min(d0, min(d1, d2)), -max(d0, max(d1, d2)));
}

/// Returns f(t), t in [0,1], by de Casteljau: within the hull, also after rounding; equal
/// coefficients give their value exactly. Largest error: 4 u max|b_k|, asserted in
/// tests/math_bernstein.
template <class T>
PELLUCID_HD constexpr T evaluate(const CubicBernstein<T>& f, T t) noexcept {
  const T p0 = interpolate(f.b[0], f.b[1], t), p1 = interpolate(f.b[1], f.b[2], t),
          p2 = interpolate(f.b[2], f.b[3], t);
  return interpolate(interpolate(p0, p1, t), interpolate(p1, p2, t), t);
}

/// Returns the same cubic on [ta,tb] (any numbers in [0,1], also equal or reversed) as a cubic on
/// [0,1]: the values of its polar form at (ta,ta,ta), (ta,ta,tb), (ta,tb,tb), (tb,tb,tb), by de
/// Casteljau (specification, 3.8). The ends equal evaluate() to the bit; nothing leaves the hull.
/// Largest error of a coefficient: 4 u max|b_k|, asserted in tests/math_bernstein.
template <class T>
PELLUCID_HD constexpr CubicBernstein<T> restrict_to(const CubicBernstein<T>& f, T ta,
                                                    T tb) noexcept {
  const T a0 = interpolate(f.b[0], f.b[1], ta), a1 = interpolate(f.b[1], f.b[2], ta),
          a2 = interpolate(f.b[2], f.b[3], ta);
  const T b0 = interpolate(f.b[0], f.b[1], tb), b1 = interpolate(f.b[1], f.b[2], tb),
          b2 = interpolate(f.b[2], f.b[3], tb);
  const T aa0 = interpolate(a0, a1, ta), aa1 = interpolate(a1, a2, ta);
  const T ab0 = interpolate(a0, a1, tb), ab1 = interpolate(a1, a2, tb);
  const T bb0 = interpolate(b0, b1, tb), bb1 = interpolate(b1, b2, tb);
  return {{interpolate(aa0, aa1, ta), interpolate(aa0, aa1, tb), interpolate(ab0, ab1, tb),
           interpolate(bb0, bb1, tb)}};
}

/// A linear function on [0,1] by its values at 0 and 1.
template <class T>
struct LinearBernstein {
  T b[2]{};

  PELLUCID_HD constexpr T hull_min() const noexcept { return min(b[0], b[1]); }
  PELLUCID_HD constexpr T hull_max() const noexcept { return max(b[0], b[1]); }
};
/// Returns the same function as a cubic.
template <class T>
PELLUCID_HD constexpr CubicBernstein<T> as_cubic(const LinearBernstein<T>& f) noexcept {
  return {{f.b[0], interpolate(f.b[0], f.b[1], T(1.0 / 3)), interpolate(f.b[0], f.b[1], T(2.0 / 3)),
           f.b[1]}};
}
template <class T>
PELLUCID_HD constexpr const CubicBernstein<T>& as_cubic(const CubicBernstein<T>& f) noexcept {
  return f;
}
template <class T>
PELLUCID_HD constexpr T evaluate(const LinearBernstein<T>& f, T t) noexcept {
  return interpolate(f.b[0], f.b[1], t);
}
template <class T>
PELLUCID_HD constexpr LinearBernstein<T> restrict_to(const LinearBernstein<T>& f, T ta,
                                                     T tb) noexcept {
  return {{interpolate(f.b[0], f.b[1], ta), interpolate(f.b[0], f.b[1], tb)}};
}

}  // namespace pellucid
