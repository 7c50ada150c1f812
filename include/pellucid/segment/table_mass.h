// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/segment/cubic_piece.h"
#include "pellucid/segment/gaussian_mixture.h"
#include "pellucid/transfer/cubic_cuts.h"

namespace pellucid {

/// A piecewise-linear transfer function of one channel along a span on which that channel is a
/// cubic.
template <class T>
struct TableMass {
  T depth{};            ///< optical depth, exact up to rounding
  Rgb<T> color{};       ///< mean color weighted by depth, also exact up to rounding
  ColorRange<T> range;  ///< contains all colors on the span
  /// Lower and upper bound on the extinction.
  T lower = T(largest<T>), upper{};
};

namespace detail {

/// Returns ∫₀¹ f², by the products of Bernstein polynomials: ∫ B_i B_j = C(3,i) C(3,j) / (7
/// C(6,i+j)).
template <class T>
PELLUCID_HD T mean_square(const CubicBernstein<T>& f) noexcept {
  const T* b = f.b;
  return (T(20) * (b[0] * b[0] + b[3] * b[3]) + T(20) * (b[0] * b[1] + b[2] * b[3]) +
          T(12) * (b[1] * b[1] + b[2] * b[2]) + T(8) * (b[0] * b[2] + b[1] * b[3]) +
          T(2) * (b[0] * b[3]) + T(18) * (b[1] * b[2])) *
         T(1.0 / 140);
}

}  // namespace detail

/// Integrates one table along a span of this length.
template <class T>
PELLUCID_HD TableMass<T> table_mass(const CubicBernstein<T>& data, const PiecewiseLinear<T>& table,
                                    T length) noexcept {
  TableMass<T> result;
  DepthWeightedColor<T> sum;
  for_each_interval(data, table, [&](int interval, T begin, T end, T front, T back) noexcept {
    const CubicPiece<T> piece = make_cubic_piece(data, table, interval, begin, end, front, back);
    const T t0 = piece.extinction_near, dt = piece.extinction_change;
    const T lo = clamp(piece.share.hull_min(), T(0), T(1));
    const T hi = clamp(piece.share.hull_max(), T(0), T(1));
    const T at_lo = t0 + lo * dt, at_hi = t0 + hi * dt;
    result.lower = min(result.lower, max(min(at_lo, at_hi), T(0)));
    result.upper = max(result.upper, max(at_lo, at_hi));
    const T mean = piece.mean_extinction();
    if (!(mean > T(0))) return;
    const Rgb<T> c0 = *piece.color_near, dc = *piece.color_far - c0;
    // ∫ (t0 + dt s)(c0 + dc s) = mean · c0 + dc ∫ (t0 + dt s) s
    const T weight = t0 * piece.share.mean() + dt * detail::mean_square(piece.share);
    sum.add(mean * ((end - begin) * length), c0 + clamp(weight / mean, T(0), T(1)) * dc);
    sum.range.add(true, c0 + lo * dc);
    sum.range.add(true, c0 + hi * dc);
  });
  result.depth = sum.depth;
  result.color = sum.color;
  result.range = sum.range;
  return result;
}

}  // namespace pellucid
