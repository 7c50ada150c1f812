// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/field/structured_grid.h"
#include "pellucid/geometry/box.h"

namespace pellucid {

/// Returns the part of a ray (in grid coordinates) that lies in the grid and in range; empty where
/// it misses. A ray that would stay in the grid forever (no direction, or one so small that every t
/// overflows) misses too: it has no end that an integral could be taken to.
template <class T>
PELLUCID_HD inline Interval<T> grid_interval(const GridAxis<T> (&axis)[3], const Ray<T>& ray_grid,
                                             Interval<T> range = {
                                                 T(0),
                                                 std::numeric_limits<T>::infinity()}) noexcept {
  const Box<T> box{{axis[0].plane(0), axis[1].plane(0), axis[2].plane(0)},
                   {axis[0].plane(axis[0].cells()), axis[1].plane(axis[1].cells()),
                    axis[2].plane(axis[2].cells())}};
  const Interval<T> t = intersect(box, ray_grid);
  const T end = min(t.end, range.end);
  return {max(t.begin, range.begin),
          end < std::numeric_limits<T>::infinity() ? end : -std::numeric_limits<T>::infinity()};
}

/// The cells that a ray crosses, front to back, each with the interval of the ray inside of it.
///
/// A plane p of axis a is met at t_a(p) = (plane(p) - origin_a) / direction_a, always computed from
/// the plane itself. Rounding keeps the order of the planes of an axis, so comparisons of these
/// numbers alone, the first cell's included, decide where the ray is: no position is compared with
/// a plane, nothing accumulates, nothing has to be nudged. What follows, exactly and for every ray:
///
/// Each interval begins at the very number where the last one ended. The first begins where the ray
/// enters the grid or the range, the last ends where it leaves them. No interval is empty: where a
/// ray passes through an edge or a vertex, the cells that it only touches are passed over. A local
/// coordinate on a plane that bounds the interval is exactly 0 or 1.
///
/// Along an axis whose direction is ±0 the ray keeps its cell. A plane belongs to the cell that the
/// ray moves into, and to the upper one where it does not move (the last plane to the last cell).
template <class T>
class StructuredWalk {
 public:
  struct Step {
    int cell[3];
    T t_begin, t_end;     ///< t_begin < t_end
    Vec3<T> entry, exit;  ///< in [0,1]³ of the cell
  };

  /// Begins a walk. The axes are referred to and must outlive it. range.begin is finite.
  PELLUCID_HD StructuredWalk(const GridAxis<T> (&axis)[3], const Ray<T>& ray_grid,
                             Interval<T> range) noexcept
      : axis_(axis) {
    const Interval<T> t = grid_interval(axis, ray_grid, range);
    t_ = t.begin;
    end_ = t.end;
    if (!hits()) return;
    for (int a = 0; a < 3; ++a) {
      origin_[a] = ray_grid.origin[a];
      direction_[a] = ray_grid.direction[a];
      cell_[a] = first_cell(a);
      prepare(a);
      const int behind = direction_[a] > T(0) ? cell_[a] : cell_[a] + 1;
      entry_[a] = direction_[a] != T(0) && plane_t(a, behind) == t_
                      ? (direction_[a] > T(0) ? T(0) : T(1))
                      : local(a, t_);
    }
  }

  /// Returns whether any cell is left: before the first step, whether the ray meets the grid in
  /// more than a point.
  PELLUCID_HD bool hits() const noexcept { return t_ < end_; }

  /// Returns the remainder of the ray, which the remaining steps cover exactly.
  PELLUCID_HD Interval<T> remaining() const noexcept { return {t_, end_}; }

  /// Finds the next cell; false behind the last one.
  PELLUCID_HD bool next(Step& step) noexcept {
    if (!hits()) return false;
    int a = nearest();
    // A plane at t_ was reached together with the last one. The last plane of an axis is not met
    // here, for end_ is not beyond it: cell_ stays in the grid.
    for (; next_[a] <= t_; a = nearest()) advance(a);

    const T t_end = min(next_[a], end_);
    step.t_begin = t_;
    step.t_end = t_end;
    for (int b = 0; b < 3; ++b) {
      step.cell[b] = cell_[b];
      step.entry[b] = entry_[b];
      entry_[b] = next_[b] <= t_end ? (direction_[b] > T(0) ? T(1) : T(0)) : local(b, t_end);
      step.exit[b] = entry_[b];
    }
    t_ = t_end;
    if (t_ < end_) advance(a);
    return true;
  }

 private:
  PELLUCID_HD T plane_t(int a, int plane) const noexcept {
    return (axis_[a].plane(plane) - origin_[a]) / direction_[a];
  }

  PELLUCID_HD int nearest() const noexcept {
    const int a = next_[1] < next_[0] ? 1 : 0;
    return next_[2] < next_[a] ? 2 : a;
  }

  /// Returns the number of planes behind t_, less one; of planes not above the origin where the ray
  /// does not move. Counted along the ray; t_ lies between the first plane and the last. By
  /// bisection, which on a uniform axis has nothing left to do where the rounded position is right.
  PELLUCID_HD int first_cell(int a) const noexcept {
    const int cells = axis_[a].cells();
    const bool reversed = direction_[a] < T(0);
    const auto behind = [&](int plane) noexcept {
      return direction_[a] == T(0) ? axis_[a].plane(plane) <= origin_[a]
                                   : plane_t(a, reversed ? cells - plane : plane) <= t_;
    };
    int lo = 0, hi = cells;
    if (axis_[a].plane_position == nullptr) {
      const int guess = find_cell(axis_[a], origin_[a] + t_ * direction_[a]);
      const int n = reversed ? cells - 1 - guess : guess;
      if (n > 0) (behind(n) ? lo : hi) = n;
      if (n + 1 < hi) (behind(n + 1) ? lo : hi) = n + 1;
    }
    while (hi - lo > 1) {
      const int mid = lo + (hi - lo) / 2;
      (behind(mid) ? lo : hi) = mid;
    }
    return reversed ? cells - 1 - lo : lo;
  }

  /// Takes in the planes of the cell that an axis stands in.
  PELLUCID_HD void prepare(int a) noexcept {
    const T upper = axis_[a].plane(cell_[a] + 1);
    lower_[a] = axis_[a].plane(cell_[a]);
    width_[a] = upper - lower_[a];
    next_[a] = direction_[a] == T(0) ? std::numeric_limits<T>::infinity()
                                     : plane_t(a, direction_[a] > T(0) ? cell_[a] + 1 : cell_[a]);
  }

  PELLUCID_HD void advance(int a) noexcept {
    const bool up = direction_[a] > T(0);
    cell_[a] += up ? 1 : -1;
    entry_[a] = up ? T(0) : T(1);
    prepare(a);
  }

  PELLUCID_HD T local(int a, T t) const noexcept {
    return clamp((origin_[a] + t * direction_[a] - lower_[a]) / width_[a], T(0), T(1));
  }

  const GridAxis<T>* axis_;
  T origin_[3]{}, direction_[3]{};
  T t_, end_;
  int cell_[3]{};
  T lower_[3]{}, width_[3]{};  ///< of the cell along each axis
  T next_[3]{};                ///< where the ray leaves it along each axis
  T entry_[3]{};               ///< local position at t_
};

}  // namespace pellucid
