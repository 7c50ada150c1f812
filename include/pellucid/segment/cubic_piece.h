// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/bernstein.h"
#include "pellucid/transfer/piecewise_linear.h"

namespace pellucid {

/// A stretch of data that is a cubic of t in [0,1] inside one interval of the transfer function.
/// Extinction and color are near + s · (far - near), with the share s(t) in [0,1] of the far
/// control point. The near control point is the one closer to the data: shares measured from it
/// keep their precision, and an extinction that vanishes there does not cancel.
template <class T>
struct CubicPiece {
  CubicBernstein<T> share;
  T extinction_near{}, extinction_change{};
  const Rgb<T>* color_near = nullptr;
  const Rgb<T>* color_far = nullptr;

  /// Returns the mean extinction: exactly that of the Bernstein coefficients. Single coefficients
  /// may be negative (a cubic from 0 to 1 can have a coefficient of 4/3 and be monotone), the mean
  /// may not.
  PELLUCID_HD T mean_extinction() const noexcept {
    return max(extinction_near + extinction_change * share.mean(), T(0));
  }
};

/// Returns the piece of `data` on [t_begin,t_end] in the given interval of the table. The caller
/// passes the values at the ends, because it knows them exactly where a control value is crossed.
template <class T>
PELLUCID_HD CubicPiece<T> make_cubic_piece(const CubicBernstein<T>& data,
                                           const PiecewiseLinear<T>& table, int interval, T t_begin,
                                           T t_end, T value_begin, T value_end) noexcept {
  CubicPiece<T> piece;
  const Material<T>* near = &table.lower_material(interval);
  const Material<T>* far = &table.upper_material(interval);
  if (interval > 0 && interval < table.count) {
    T origin = table.value[interval - 1], change = table.value[interval] - origin;
    const T middle = T(0.5) * value_begin + T(0.5) * value_end;
    if (middle - origin > T(0.5) * change) {
      origin = table.value[interval];
      change = -change;
      const Material<T>* swap = near;
      near = far;
      far = swap;
    }
    // Differences to the origin come before the restriction: they are small where the data are
    // close to it, and the restriction's rounding is relative to them.
    const CubicBernstein<T> offset{
        {data.b[0] - origin, data.b[1] - origin, data.b[2] - origin, data.b[3] - origin}};
    const bool whole = t_begin == T(0) && t_end == T(1);
    const CubicBernstein<T> part = whole ? offset : restrict_to(offset, t_begin, t_end);
    // A cubic with values in [0,1] has coefficients in [-2,3] (those of Chebyshev's T3 are the
    // extreme ones): the clamp only changes rounding errors of very narrow intervals.
    piece.share = {{clamp((value_begin - origin) / change, T(0), T(1)),
                    clamp(part.b[1] / change, T(-2), T(3)), clamp(part.b[2] / change, T(-2), T(3)),
                    clamp((value_end - origin) / change, T(0), T(1))}};
  }
  piece.extinction_near = near->extinction;
  piece.extinction_change = far->extinction - near->extinction;
  piece.color_near = &near->color;
  piece.color_far = &far->color;
  return piece;
}

}  // namespace pellucid
