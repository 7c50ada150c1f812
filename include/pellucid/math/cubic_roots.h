// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/bernstein.h"

namespace pellucid {

/// The positions in (0,1), ascending, of a cubic's extrema. With 0 and 1 they bound its monotone
/// pieces, at most three.
template <class T>
struct CriticalPoints {
  T t[2]{};
  int count = 0;
};

/// Returns the extrema of a cubic in (0,1).
///
/// f'/3 = d0 (1-t)² + 2 d1 t (1-t) + d2 t² with d_k = b_{k+1} - b_k has the coefficients d0, 2 B, A
/// in powers of t; B = d1 - d0, A = d0 - 2 d1 + d2 (specification, 3.8). The two roots are w/A and
/// d0/w with w = -(B + sign(B) √(B² - A d0)), which adds numbers of the same sign: nothing cancels
/// if A or d0 vanishes. The radicand is d1² - d0 d2 (the discriminant does not depend on the
/// basis), computed with one rounding of its products' difference (fma), so that its sign is
/// correct unless it is zero to rounding. The differences are scaled by the largest one, so that
/// squares neither overflow nor underflow.
///
/// A double root (the slope touches zero without a change of sign) may be reported twice, once or
/// not at all; every choice bounds monotone pieces. A constant has no extrema.
template <class T>
PELLUCID_HD CriticalPoints<T> critical_points(const CubicBernstein<T>& f) noexcept {
  CriticalPoints<T> result;
  T d0 = f.b[1] - f.b[0], d1 = f.b[2] - f.b[1], d2 = f.b[3] - f.b[2];
  // One sign throughout: monotone. The usual case, and the constant one.
  if ((d0 >= T(0) && d1 >= T(0) && d2 >= T(0)) || (d0 <= T(0) && d1 <= T(0) && d2 <= T(0))) {
    return result;
  }
  const T scale = max(abs(d0), max(abs(d1), abs(d2)));
  d0 /= scale;
  d1 /= scale;
  d2 /= scale;
  // d1² - d0 d2 by Kahan: fma recovers the rounding of one product.
  const T product = d0 * d2;
  const T radicand = fma(d1, d1, -product) + fma(-d0, d2, product);
  if (radicand < T(0)) return result;
  const T b = d1 - d0;
  const T a = (d2 - d1) - b;
  const T w = -(b + copysign(sqrt(radicand), b));
  T first = T(-1), second = T(-1);  // outside: not there
  if (a != T(0)) first = w / a;
  if (w != T(0)) second = d0 / w;
  if (first > second) {
    const T swap = first;
    first = second;
    second = swap;
  }
  if (first > T(0) && first < T(1)) result.t[result.count++] = first;
  if (second > T(0) && second < T(1) && second != first) result.t[result.count++] = second;
  return result;
}

/// Returns the position in [ta,tb] at which f crosses c. Preconditions: f is monotone there, and
/// f(ta), f(tb) lie on different sides of c, or at it; then there is exactly one crossing. `rising`
/// is the direction.
///
/// Newton's method from the secant point, in a bracket that always contains the root. A step that
/// would leave the bracket, or does not halve the step before last, becomes a bisection. It ends
/// when the position is found to the working precision of t.
///
/// Error: that of a root whose function value has an error of 4 u max|b_k - c|, asserted in
/// tests/math_bernstein; a few u where f is steep, √u at an extremum.
template <class T>
PELLUCID_HD T find_crossing(const CubicBernstein<T>& f, T c, T ta, T tb, bool rising) noexcept {
  // f - c with f rising, so that the differences are rounded once, close to the root.
  const T sign = rising ? T(1) : T(-1);
  const T g0 = sign * (f.b[0] - c), g1 = sign * (f.b[1] - c), g2 = sign * (f.b[2] - c),
          g3 = sign * (f.b[3] - c);
  const auto value_and_slope = [&](T t, T& slope) noexcept {
    const T p0 = interpolate(g0, g1, t), p1 = interpolate(g1, g2, t), p2 = interpolate(g2, g3, t);
    const T q0 = interpolate(p0, p1, t), q1 = interpolate(p1, p2, t);
    slope = T(3) * (q1 - q0);
    return interpolate(q0, q1, t);
  };
  T lo = ta, hi = tb;
  T slope;
  const T value_lo = value_and_slope(ta, slope);
  if (!(value_lo < T(0))) return ta;
  const T value_hi = value_and_slope(tb, slope);
  if (!(value_hi > T(0))) return tb;
  T t = lo + (hi - lo) * (-value_lo / (value_hi - value_lo));
  T step = hi - lo, step_before = step;
  // Each step halves the bracket or the step before last: 2·64 of them exhaust binary64.
  for (int i = 0; i < 128; ++i) {
    if (!(t > lo && t < hi)) {
      t = lo + T(0.5) * (hi - lo);
      if (!(t > lo && t < hi)) return lo;  // neighbours in the number system
    }
    const T value = value_and_slope(t, slope);
    if (value == T(0)) return t;
    (value < T(0) ? lo : hi) = t;
    const T newton = -value / slope;  // infinite where the slope vanishes
    if (abs(newton) <= T(2) * rounding_unit<T> * t) return clamp(t + newton, lo, hi);
    T next = t + newton;
    if (!(next > lo && next < hi && T(2) * abs(newton) <= abs(step_before))) {
      next = lo + T(0.5) * (hi - lo);
    }
    step_before = step;
    step = next - t;
    t = next;
  }
  return t;
}

}  // namespace pellucid
