// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "pellucid/geometry/affine.h"
#include "pellucid/simd/scalar.h"
#include "pellucid/traverse/structured_walk.h"

namespace pellucid {

/// Tells which cells a ray may run in besides those that a walk finds: where it runs along a plane
/// between cells, rounding decides on which side. And how far off the places are where it crosses
/// planes: the flatter, the farther.
class PlaneAmbiguity {
 public:
  using Step = StructuredWalk<double>::Step;

  /// Takes a ray in the world.
  void start(const Affine<double>& grid_from_world, const Ray<double>& ray) {
    const Mat3<double>& m = grid_from_world.matrix;
    along_ = grid_from_world.vector(ray.direction);
    for (int a = 0; a < 3; ++a) {
      double origin = std::abs(grid_from_world.translation[a]), direction = 0;
      for (int c = 0; c < 3; ++c) {
        origin += std::abs(m.column[c][a] * ray.origin[c]);
        direction += std::abs(m.column[c][a] * ray.direction[c]);
      }
      // The map of the ray, its inverse, t and the plane: a few roundings each.
      origin_[a] = 16 * rounding_unit<double> * origin;
      direction_[a] = 16 * rounding_unit<double> * direction;
    }
  }

  /// Returns how far the ends of a step may be from where they are thought to be, together, world
  /// length.
  double position_error(const Step& step) const {
    double entry = 0, exit = 0;
    for (int a = 0; a < 3; ++a) {
      if (along_[a] == 0) continue;
      const double off = (origin_[a] + direction_[a] * step.t_end) / std::abs(along_[a]);
      if (step.entry[a] == 0 || step.entry[a] == 1) entry = std::max(entry, off);
      if (step.exit[a] == 0 || step.exit[a] == 1) exit = std::max(exit, off);
    }
    return std::min(entry + exit, step.t_end);
  }

  /// Returns whether the ray, which is `ray` in the grid's coordinates, may be on either side of a
  /// plane between cells for more than a thousandth of its way through `inside`. The planes are at
  /// whole numbers.
  bool runs_along_planes(const Ray<double>& ray, const Interval<double>& inside) const {
    for (int a = 0; a < 3; ++a) {
      const double begin = ray.origin[a] + inside.begin * ray.direction[a];
      const double end = ray.origin[a] + inside.end * ray.direction[a];
      const double off = origin_[a] + direction_[a] * inside.end;
      const double least = std::min(begin, end) - off, most = std::max(begin, end) + off;
      if (std::floor(most) >= least && std::abs(end - begin) <= 1000 * off) return true;
    }
    return false;
  }

  /// Calls visit(cell) for each neighbor of the step's cell that its part of the ray may be in.
  /// `axis`: that of the walk.
  template <class Visit>
  void for_each_other_cell(const GridAxis<double> (&axis)[3], const Step& step,
                           const Visit& visit) const {
    int first[3], last[3];
    bool any = false;
    for (int a = 0; a < 3; ++a) {
      const int cell = step.cell[a];
      const double width = axis[a].plane(cell + 1) - axis[a].plane(cell);
      const double off = (origin_[a] + direction_[a] * step.t_end) / width;
      const double lower = std::min(step.entry[a], step.exit[a]);
      const double upper = std::max(step.entry[a], step.exit[a]);
      first[a] = upper <= off && cell > 0 ? cell - 1 : cell;
      last[a] = 1 - lower <= off && cell + 1 < axis[a].cells() ? cell + 1 : cell;
      any = any || first[a] < last[a];
    }
    if (!any) return;
    int cell[3];
    for (cell[2] = first[2]; cell[2] <= last[2]; ++cell[2]) {
      for (cell[1] = first[1]; cell[1] <= last[1]; ++cell[1]) {
        for (cell[0] = first[0]; cell[0] <= last[0]; ++cell[0]) {
          if (!std::equal(cell, cell + 3, step.cell)) visit(cell);
        }
      }
    }
  }

 private:
  double origin_[3]{}, direction_[3]{};  ///< rounding of a position, and per t; grid coordinates
  Vec3<double> along_{};                 ///< the ray's direction, grid coordinates per length
};

}  // namespace pellucid
