// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/field/trilinear.h"
#include "pellucid/traverse/structured_walk.h"

namespace pellucid {

/// Field along a ray inside one cell: the data as a polynomial of u in [0, 1], exactly, and where
/// the stretch lies on the ray.
template <class T>
struct CubicSpan {
  CubicBernstein<T> data;
  double t_begin, t_end;  ///< world arc length, front to back

  /// Returns the world length. The difference is formed in double: a short stretch far from the eye
  /// keeps its length.
  PELLUCID_HD T length() const noexcept { return static_cast<T>(t_end - t_begin); }
};

/// Returns the span of one step of a walk; false where the cell has a NaN corner: vacuum.
template <class T, class Value>
PELLUCID_HD bool make_span(const StructuredGrid<Value, double>& grid,
                           const StructuredWalk<double>::Step& step, CubicSpan<T>& span) noexcept {
  const CellCorners<T> corners = grid.template corners<T>(step.cell[0], step.cell[1], step.cell[2]);
  if constexpr (!std::is_integral_v<Value>) {
    T sum = corners.value[0];
    for (int n = 1; n < 8; ++n) sum += corners.value[n];
    if (is_nan(sum)) return false;
  }
  const Vec3<T> entry{static_cast<T>(step.entry.x), static_cast<T>(step.entry.y),
                      static_cast<T>(step.entry.z)};
  const Vec3<T> exit{static_cast<T>(step.exit.x), static_cast<T>(step.exit.y),
                     static_cast<T>(step.exit.z)};
  span = {trilinear_cubic(corners, entry, exit), step.t_begin, step.t_end};
  return true;
}

/// Calls visit(CubicSpan<T>) for each cell that the ray (in grid coordinates) crosses in this
/// range, front to back, until it returns false. Cells with a NaN corner are vacuum and are passed
/// over. Returns the number of cells walked through. The walk is in double, whatever T: its
/// positions are differences of large numbers where the eye is far away.
template <class T, class Value, class Visit>
PELLUCID_HD long for_each_span(const StructuredGrid<Value, double>& grid,
                               const Ray<double>& ray_grid, Visit&& visit,
                               Interval<double> range = {
                                   0, std::numeric_limits<double>::infinity()}) noexcept {
  StructuredWalk<double> walk(grid.axis, ray_grid, range);
  typename StructuredWalk<double>::Step step;
  long cells = 0;
  while (walk.next(step)) {
    ++cells;
    CubicSpan<T> span;
    if (make_span(grid, step, span) && !visit(span)) break;
  }
  return cells;
}

}  // namespace pellucid
