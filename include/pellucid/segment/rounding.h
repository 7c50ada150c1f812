// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/bernstein.h"
#include "pellucid/segment/bounded.h"
#include "pellucid/transfer/piecewise_linear.h"

namespace pellucid {

/// What a transfer function does to small errors of the data, over some of its intervals.
template <class T>
struct Sensitivity {
  T largest_extinction{};
  T extinction_slope{};  ///< largest |change of extinction| per data value, jumps left out
  T color_slope{};       ///< the same of any color channel
  bool jump = false;     ///< whether two control points have (nearly) one value

  T color_jumps{};  ///< how much the color changes in those, in all

  /// How far apart the colors of data within `range` of each other may be.
  PELLUCID_HD T color_change(T range, T largest_color) const noexcept {
    return min(color_slope * range + color_jumps, largest_color);
  }
};

/// Over the intervals first … last of the table: a loop, for the few that a cell reaches. What is
/// narrower than a few data_error is a jump.
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

/// For how much of [0,1] the data are within `distance` of `value`, at most, by pieces: where a
/// piece is monotone, 2 · distance over its least slope; where it turns, √(distance / oscillation)
/// of it twice, as at the tip of a parabola (an estimate).
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

/// How much the jumps in the intervals first … last change the depth when each is off by
/// `distance`: the jumps' sizes times the share of the length near them.
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

/// How far rounding in T can move the data along a cell: 32 u max|b|, of which 13 u are those of
/// trilinear_cubic(), as much comes from its positions, the rest from differences and crossings.
/// Equal corners give their value exactly, but in binary32 neither they nor the control values are
/// what was given.
template <class T>
PELLUCID_HD T data_rounding(const CubicBernstein<T>& data) noexcept {
  const T lower = data.hull_min(), upper = data.hull_max();
  return is_single<T> || upper > lower ? T(32) * T(rounding_unit<T>) * max(abs(lower), abs(upper))
                                       : T(0);
}

/// What rounding in T can do to the segment of a cell.
///
/// Data that are off by data_error move the depth by data_error · slope · length, the color by
/// data_error · slope of the color, and the place of a jump to where the data are near it. The
/// closed forms add 32 u of the opacity. At least twice what tests/segment finds.
template <class T>
struct RoundingError {
  T color{};  ///< of the color, per opacity
  T depth{};  ///< of the optical depth, beside that of the closed forms

  /// color_error and opacity_error of a segment in the manner of BoundedSegment. Depths beyond
  /// which nothing is seen may be off by any amount.
  PELLUCID_HD T color_error(T opacity) const noexcept { return opacity * color; }
  PELLUCID_HD T opacity_error(T opacity, T transparency) const noexcept {
    constexpr T u = T(rounding_unit<T>);
    // e^x - 1 <= 2 x for x <= 1.
    const T moved =
        depth <= T(1) ? T(2) * depth * transparency : transparency * exp(min(depth, T(80)));
    return T(32) * u * opacity + min(moved, T(1));
  }
};

/// `first`, `last`: the intervals that the data reach, widened by data_error.
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
