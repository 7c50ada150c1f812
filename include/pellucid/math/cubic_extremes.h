// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/cubic_roots.h"

namespace pellucid {

/// Returns the largest value of a cubic on [0,1].
///
///   max f = max(f(0), f(1), f(t_k)),  f'(t_k) = 0,  0 < t_k < 1
///
/// critical_points() solves the quadratic f' = 0 without cancellation. An error of t_k changes f by
/// its square only, as the slope vanishes there: the value is as accurate as evaluate(). If no
/// inner coefficient is above both ends, the hull says that the larger end is the maximum, and no
/// root is needed.
///
/// The result is in [max(b0, b3), max b_k]. Valid for finite coefficients with finite differences.
/// Largest error: 3 u max|b_k|, asserted in tests/math_bernstein; 0 if an end is the maximum.
template <class T>
PELLUCID_HD T largest_value(const CubicBernstein<T>& f) noexcept {
  T most = max(f.b[0], f.b[3]);
  if (f.b[1] <= most && f.b[2] <= most) return most;
  const CriticalPoints<T> turn = critical_points(f);
  for (int k = 0; k < turn.count; ++k) most = max(most, evaluate(f, turn.t[k]));
  return most;
}

/// Returns the smallest value of a cubic on [0,1], with the error of largest_value().
template <class T>
PELLUCID_HD T smallest_value(const CubicBernstein<T>& f) noexcept {
  return -largest_value(CubicBernstein<T>{{-f.b[0], -f.b[1], -f.b[2], -f.b[3]}});
}

}  // namespace pellucid
