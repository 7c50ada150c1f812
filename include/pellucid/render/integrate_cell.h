// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/error/precision.h"
#include "pellucid/render/ray_result.h"
#include "pellucid/render/transfer_tables.h"
#include "pellucid/segment/cubic.h"
#include "pellucid/segment/line_rule.h"
#include "pellucid/segment/rounding.h"

namespace pellucid {

/// Accuracy requested of every ray.
struct RayTolerance {
  /// Largest error of the ray's result, in each channel of premultiplied RGBA.
  double tolerance = 1.0 / 512;
  Grade grade = Grade::estimated;
  Precision precision = Precision::automatic;
  /// C_max of theorem (3): an upper bound on the colors of the transfer function and of the
  /// background.
  double largest_color = 1;

  friend bool operator==(const RayTolerance&, const RayTolerance&) = default;
};

/// A cell's segment by the cheapest rule within budget, with its error.
template <class T>
struct CellSegment {
  BoundedSegment<T> found;  ///< with the errors of the method
  double rounding = 0;      ///< contribution of rounding, in the unit of RayBudget::spend()
  double opacity = 0;       ///< upper bound on the opacity, for which the allowance was computed
  bool clear = false;       ///< nothing absorbs
  bool line = false;        ///< computed by line_rule()

  /// Returns the total error, in the unit of RayBudget::spend().
  PELLUCID_HD double error(double largest_color) const noexcept {
    return static_cast<double>(found.color_error) +
           largest_color * static_cast<double>(found.opacity_error) + rounding;
  }
};

/// Integrates a cell, or a part of one, in T. `position_error` bounds the error of the positions of
/// its ends, in world length. allowance(opacity) returns the largest permitted error. Unless
/// `forced`, returns false if T's rounding would take more than a quarter of it.
template <class T, class Allowance>
PELLUCID_HD bool integrate_cell(const CubicBernstein<T>& data, T length, double position_error,
                                const TransferTables& transfer, const RayTolerance& wanted,
                                bool forced, Allowance&& allowance,
                                CellSegment<T>& result) noexcept {
  const PiecewiseLinear<T>& table = transfer.table<T>();
  const double largest_color = max(wanted.largest_color, 1.0);
  const T data_error = data_rounding(data);
  const T lower = data.hull_min(), upper = data.hull_max();
  // Squares of the data's differences must not underflow in binary32.
  if (!forced && !(max(abs(lower), abs(upper)) > T(1e-15)) && upper > lower) return false;
  const bool lacks =
      is_single<T> && transfer.single_is_inexact(static_cast<double>(lower - data_error),
                                                 static_cast<double>(upper + data_error));
  if (lacks && !forced) return false;
  const detail::IntervalRange reach =
      detail::interval_range(table, lower - data_error, upper + data_error);
  result = {};
  if (!table.has_extinction(reach.first, reach.last) && !lacks) {
    result.clear = true;
    return true;
  }
  const Sensitivity<T> slopes = sensitivity(table, reach.first, reach.last, data_error);
  const T opacity = min(slopes.largest_extinction * length, T(1));
  result.opacity = static_cast<double>(opacity);
  const double allowed = allowance(result.opacity);
  RoundingError<T> rounding = rounding_error(data, length, T(largest_color), table, reach.first,
                                             reach.last, data_error, slopes);
  // Extinction on the other side of an interval narrower than data_error shows another color.
  const T colors = min(slopes.color_jumps, T(largest_color));
  const double shifted = static_cast<double>(colors * min(rounding.depth, T(1)));
  // An error of the ends' positions moves extinction, with the color that it has there.
  rounding.depth += static_cast<T>(position_error) * slopes.largest_extinction;
  const auto rounding_cost = [&](const T alpha, const T transparency) noexcept {
    if (lacks) return largest_color;  // anything may be there
    return shifted + static_cast<double>(rounding.color_error(alpha)) +
           largest_color * static_cast<double>(rounding.opacity_error(alpha, transparency));
  };
  // The upper bound, with full transparency.
  const double at_most = rounding_cost(opacity, T(1));
  if (!forced && !(at_most <= 0.25 * allowed)) return false;
  const double left = max(allowed - at_most, 0.25 * allowed);

  if (reach.first != reach.last) {
    result.found = line_rule(data, length, table, transfer.antiderivative<T>());
    result.line = result.error(largest_color) <= left;  // `rounding` is still 0
  }
  if (!result.line) {
    result.found = integrate_cubic(
        data, length, table, static_cast<T>(left / static_cast<double>(opacity)), wanted.grade);
  }
  result.rounding = rounding_cost(result.found.segment.opacity, result.found.segment.transparency);
  return true;
}

}  // namespace pellucid
