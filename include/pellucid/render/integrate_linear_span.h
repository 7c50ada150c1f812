// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/render/integrate_cell.h"
#include "pellucid/segment/piecewise_linear.h"

namespace pellucid {

/// Data that are linear from the front of a span to its back.
struct LinearData {
  double front = 0, back = 0;
  double error = 0;           ///< largest error of the values, beside their rounding
  double length = 0;          ///< world units
  double position_error = 0;  ///< of ends at which the data continue, world units
  double end_error = 0;       ///< of ends at which the data end, world units
};

/// Integrates a span with linear data in T: Moreland's integral between control points
/// (segment/piecewise_linear.h), so that rounding is the only error. `forced`, allowance() and the
/// result are those of integrate_cell().
template <class T, class Allowance>
PELLUCID_HD bool integrate_linear_span(const LinearData& data, const TransferTables& transfer,
                                       double largest_color, bool forced, Allowance&& allowance,
                                       CellSegment<T>& result) noexcept {
  const PiecewiseLinear<T>& table = transfer.table<T>();
  const T front = static_cast<T>(data.front), back = static_cast<T>(data.back),
          length = static_cast<T>(data.length);
  const T lower = min(front, back), upper = max(front, back);
  const T third = T(1.0 / 3) * (back - front);
  const CubicBernstein<T> cubic{{front, front + third, back - third, back}};
  const T data_error = data_rounding(cubic) + static_cast<T>(data.error);
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
  RoundingError<T> rounding = rounding_error(cubic, length, T(largest_color), table, reach.first,
                                             reach.last, data_error, slopes);
  // Data between the two possible positions of an end are between its value and those of the span.
  const T range = upper - lower + T(2) * data_error;
  const T change = slopes.jump ? slopes.largest_extinction
                               : min(slopes.extinction_slope * range, slopes.largest_extinction);
  const T colors = slopes.color_change(range, T(largest_color)),
          position_error = static_cast<T>(data.position_error);
  rounding.depth +=
      position_error * change + static_cast<T>(data.end_error) * slopes.largest_extinction;
  rounding.color += position_error < length ? colors * (position_error / length) : colors;
  // Displaced extinction shows another color of the span.
  const double shifted = static_cast<double>(colors * min(rounding.depth, T(1)));
  // Control points beyond the sixteenth cost 3 u each.
  const T more = T(3 * rounding_unit<T>) * T(max(reach.last - reach.first - 16, 0));
  const auto cost = [&](const T alpha, const T transparency) noexcept {
    if (lacks) return largest_color;  // anything may be there
    return shifted + static_cast<double>(rounding.color_error(alpha)) +
           largest_color *
               static_cast<double>(rounding.opacity_error(alpha, transparency) + more * alpha);
  };
  if (!forced && !(cost(opacity, T(1)) <= 0.25 * allowance(result.opacity))) return false;
  result.found.segment = piecewise_linear_segment(table, front, back, length);
  result.rounding = cost(result.found.segment.opacity, result.found.segment.transparency);
  return true;
}

}  // namespace pellucid
