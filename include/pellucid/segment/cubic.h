// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/segment/cubic_emission.h"
#include "pellucid/transfer/cubic_cuts.h"

namespace pellucid {

namespace detail {

/// The intervals of the table that the data can reach, judged by the hull; usually first == last.
struct IntervalRange {
  int first, last;
};
template <class T>
PELLUCID_HD IntervalRange interval_range(const PiecewiseLinear<T>& table, T lower,
                                         T upper) noexcept {
  const int first = table.interval(lower);
  const bool one = first == table.count || upper < table.value[first];
  return {first, one ? first : table.interval(upper)};
}
template <class T>
PELLUCID_HD IntervalRange interval_range(const CubicBernstein<T>& data,
                                         const PiecewiseLinear<T>& table) noexcept {
  return interval_range(table, data.hull_min(), data.hull_max());
}

}  // namespace detail

/// Integrates the volume rendering integral (particle model) over cubic data, as in a trilinear
/// cell, through a piecewise-linear transfer function (specification, 3.8).
///
/// Depth, opacity and transparency are exact up to rounding: between control values the extinction
/// is a cubic with known coefficients. The radiance is in closed form if the color is constant or
/// the data are linear, else within tolerance · opacity per channel and unit of color, so that the
/// errors of the segments along a ray sum to at most the tolerance (2.3). cubic_piece_segment()
/// chooses the scheme: with proved bounds in the grade `proved`, else Gauss panels with measured
/// errors.
///
/// Preconditions: length >= 0, tolerance > 0, finite data with finite differences. Tolerances down
/// to 1e-6 (float) and 1e-12 (double) are met on tests/reference_tables/trilinear_cell.csv,
/// asserted in tests/segment. If data values are large compared to the table's intervals, rounding
/// adds the error of their difference: u · max|data| / interval.
template <class T>
PELLUCID_HD BoundedSegment<T> integrate_cubic(const CubicBernstein<T>& data, T length,
                                              const PiecewiseLinear<T>& table, T tolerance,
                                              Grade grade) noexcept {
  const detail::IntervalRange reach = detail::interval_range(data, table);
  if (!table.has_extinction(reach.first, reach.last)) return {};
  if (reach.first == reach.last) {
    const CubicPiece<T> piece =
        make_cubic_piece(data, table, reach.first, T(0), T(1), data.b[0], data.b[3]);
    return cubic_piece_segment(piece, length, tolerance, grade);
  }
  BoundedSegment<T> result;
  for_each_interval(
      data, table, [&](int interval, T t_begin, T t_end, T value_begin, T value_end) noexcept {
        if (!table.has_extinction(interval, interval)) return;
        const CubicPiece<T> piece =
            make_cubic_piece(data, table, interval, t_begin, t_end, value_begin, value_end);
        // Behind an opaque front the depth-weighted color suffices.
        const bool matters = result.segment.transparency > T(1.0 / 64) * tolerance;
        result = compose(result, cubic_piece_segment(piece, length * (t_end - t_begin),
                                                     matters ? tolerance : T(largest<T>), grade));
      });
  result.segment.opacity = min(result.segment.opacity, T(1));
  return result;
}

/// Returns the segment only, with the radiance within `tolerance` by estimate.
template <class T>
PELLUCID_HD SegmentResult<T> integrate_cubic(const CubicBernstein<T>& data, T length,
                                             const PiecewiseLinear<T>& table,
                                             T tolerance) noexcept {
  return integrate_cubic(data, length, table, tolerance, Grade::estimated).segment;
}

/// Returns the optical depth of integrate_cubic() only: exact up to rounding, without an
/// exponential.
template <class T>
PELLUCID_HD T optical_depth_cubic(const CubicBernstein<T>& data, T length,
                                  const PiecewiseLinear<T>& table) noexcept {
  const detail::IntervalRange reach = detail::interval_range(data, table);
  if (!table.has_extinction(reach.first, reach.last)) return T(0);
  if (reach.first == reach.last) {
    return length * make_cubic_piece(data, table, reach.first, T(0), T(1), data.b[0], data.b[3])
                        .mean_extinction();
  }
  T depth = T(0);
  for_each_interval(
      data, table, [&](int interval, T t_begin, T t_end, T value_begin, T value_end) noexcept {
        if (!table.has_extinction(interval, interval)) return;
        depth += length * (t_end - t_begin) *
                 make_cubic_piece(data, table, interval, t_begin, t_end, value_begin, value_end)
                     .mean_extinction();
      });
  return depth;
}

}  // namespace pellucid
