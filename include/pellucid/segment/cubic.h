// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/segment/cubic_emission.h"
#include "pellucid/transfer/cubic_cuts.h"

namespace pellucid {

namespace detail {

/// The intervals of the table that the data can reach, by the hull; first == last is the usual
/// case.
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

/// The volume rendering integral (particle model) over data that are a cubic along the segment, as
/// in a trilinear cell, seen through a piecewise-linear transfer function (specification, 3.8).
///
/// Depth, opacity and transparency are exact up to rounding: on each stretch between control values
/// the extinction is a cubic with known coefficients. Radiance: closed where the color is constant
/// or the data are linear, else within tolerance · opacity per channel and unit of color, so that
/// the errors of the segments along a ray sum to at most the tolerance (2.3). The scheme for it is
/// chosen in cubic_emission(); in grade proved by bounds that are, else where it is a Gauss
/// panel by measurement.
///
/// Wanted: length >= 0, tolerance > 0, finite data whose differences are finite. Tolerances down to
/// 1e-6 (float) and 1e-12 (double) are met on tests/reference_tables/trilinear_cell.csv, asserted
/// in tests/segment. What rounding adds where data values are large against the table's intervals
/// is that of their difference: u · max|data| / interval.
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
        // Behind an opaque front the depth-weighted color will do.
        const bool matters = result.segment.transparency > T(1.0 / 64) * tolerance;
        result = compose(result, cubic_piece_segment(piece, length * (t_end - t_begin),
                                                     matters ? tolerance : T(largest<T>), grade));
      });
  result.segment.opacity = min(result.segment.opacity, T(1));
  return result;
}

/// The segment alone, its radiance within `tolerance` by estimate.
template <class T>
PELLUCID_HD SegmentResult<T> integrate_cubic(const CubicBernstein<T>& data, T length,
                                             const PiecewiseLinear<T>& table,
                                             T tolerance) noexcept {
  return integrate_cubic(data, length, table, tolerance, Grade::estimated).segment;
}

/// The optical depth of integrate_cubic() alone: exact up to rounding, no exponential.
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
