// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/bernstein.h"
#include "pellucid/segment/bounded.h"
#include "pellucid/transfer/piecewise_linear.h"

namespace pellucid {

/// The sensitivity of a transfer function to small errors of the data, over some of its intervals.
template <class T>
struct Sensitivity {
  T largest_extinction{};
  T extinction_slope{};  ///< largest |slope| of the extinction, jumps excluded
  T color_slope{};       ///< largest |slope| of any color channel, jumps excluded
  bool jump = false;     ///< whether two control points have (nearly) the same value

  T color_jumps{};  ///< total change of the color in those

  /// Returns the largest difference between the colors of data within `range` of each other.
  PELLUCID_HD T color_change(T range, T largest_color) const noexcept {
    return min(color_slope * range + color_jumps, largest_color);
  }
};

/// Returns the sensitivity over the intervals first … last of the table, by a loop over the few
/// intervals that a cell reaches. Intervals narrower than 4 data_error count as jumps.
template <class T>
PELLUCID_HD Sensitivity<T> sensitivity(const PiecewiseLinear<T>& table, int first, int last,
                                       T data_error) noexcept {
  Sensitivity<T> result;
  for (int i = first; i <= last; ++i) {
    const Material<T>&a = table.lower_material(i), &b = table.upper_material(i);
    result.largest_extinction = max(result.largest_extinction, max(a.extinction, b.extinction));
    if (i == 0 || i == table.count) continue;
    const T width = table.value[i] - table.value[i - 1];
    const T extinction = abs(b.extinction - a.extinction);
    const T color = largest_component(b.color - a.color);
    if (!(width > T(4) * data_error)) {
      result.jump = true;
      result.color_jumps += color;
      continue;
    }
    result.extinction_slope = max(result.extinction_slope, extinction / width);
    if (max(a.extinction, b.extinction) > T(0)) {
      result.color_slope = max(result.color_slope, color / width);
    }
  }
  return result;
}

/// Returns an upper bound on the fraction of [0,1] in which the data are within `distance` of
/// `value`, by pieces: on a monotone piece 2 · distance over its smallest slope; on a piece with an
/// extremum twice √(distance / oscillation) of it, as at the vertex of a parabola (an estimate).
template <class T>
PELLUCID_HD T share_near(const CubicBernstein<T>& data, T value, T distance) noexcept {
  constexpr int pieces = 16;
  T share = T(0);
  for (int i = 0; i < pieces; ++i) {
    const CubicBernstein<T> part =
        restrict_to(data, T(i) * T(1.0 / pieces), T(i + 1) * T(1.0 / pieces));
    const T lower = part.hull_min(), upper = part.hull_max();
    if (value < lower - distance || value > upper + distance) continue;
    const T slope = least_slope(part);
    const T within = slope > T(0)           ? T(2) * distance / slope
                     : upper - lower > T(0) ? T(2) * sqrt(distance / (upper - lower))
                                            : T(1);
    share += min(within, T(1)) * T(1.0 / pieces);
  }
  return share;
}

/// Returns the change of the depth by the jumps in the intervals first … last if each is displaced
/// by `distance`: the sizes of the jumps times the fraction of the length near them.
template <class T>
PELLUCID_HD T jump_rounding(const CubicBernstein<T>& data, const PiecewiseLinear<T>& table,
                            int first, int last, T distance) noexcept {
  T sum = T(0);
  for (int i = max(first, 1); i <= min(last, table.count - 1); ++i) {
    if (table.value[i] - table.value[i - 1] > T(4) * distance) continue;
    // A jump of the color alone counts with the extinction that shows it.
    const T size = max(table.material[i - 1].extinction, table.material[i].extinction);
    if (size > T(0)) sum += size * share_near(data, table.value[i], T(5) * distance);
  }
  return sum;
}

/// Returns the largest effect of rounding in T on the data along a cell: 32 u max|b|. 13 u of it
/// are those of trilinear_cubic(), as much comes from its positions, the rest from differences and
/// crossings. Equal corners give their value exactly; in binary32, however, neither they nor the
/// control values are exact.
template <class T>
PELLUCID_HD T data_rounding(const CubicBernstein<T>& data) noexcept {
  const T lower = data.hull_min(), upper = data.hull_max();
  return is_single<T> || upper > lower ? T(32) * T(rounding_unit<T>) * max(abs(lower), abs(upper))
                                       : T(0);
}

/// The effect of rounding in T on the segment of a cell.
///
/// Data with an error data_error change the depth by data_error · slope · length, the color by
/// data_error · slope of the color, and the position of a jump within the part where the data are
/// near it. The closed forms add 32 u of the opacity. At least twice the errors that tests/segment
/// finds.
template <class T>
struct RoundingError {
  T color{};  ///< of the color, relative to the opacity
  T depth{};  ///< of the optical depth, in addition to that of the closed forms

  /// Return color_error and opacity_error of a segment as in BoundedSegment. The error of the depth
  /// is ignored beyond the depth at which a segment is opaque.
  PELLUCID_HD T color_error(T opacity) const noexcept { return opacity * color; }
  PELLUCID_HD T opacity_error(T opacity, T transparency) const noexcept {
    constexpr T u = T(rounding_unit<T>);
    // e^x - 1 <= 2 x for x <= 1.
    const T moved =
        depth <= T(1) ? T(2) * depth * transparency : transparency * exp(min(depth, T(80)));
    return T(32) * u * opacity + min(moved, T(1));
  }
};

/// Returns the effect of rounding. `first` and `last` are the intervals that the data reach,
/// widened by data_error.
template <class T>
PELLUCID_HD RoundingError<T> rounding_error(const CubicBernstein<T>& data, T length,
                                            T largest_color, const PiecewiseLinear<T>& table,
                                            int first, int last, T data_error,
                                            const Sensitivity<T>& slopes) noexcept {
  T depth = data_error * slopes.extinction_slope * length;
  if (slopes.jump && data_error > T(0)) {
    depth += length * jump_rounding(data, table, first, last, data_error);
  }
  return {T(32) * T(rounding_unit<T>) * largest_color +
              min(data_error * slopes.color_slope, largest_color),
          depth};
}

}  // namespace pellucid
