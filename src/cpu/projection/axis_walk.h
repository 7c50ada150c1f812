// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "pellucid/field/structured_grid.h"
#include "pellucid/geometry/ray.h"

namespace pellucid {

/// A ray in a grid's coordinates, for AxisWalk.
struct WalkRay {
  double origin[3], direction[3], inverse[3];  ///< inverse: 1 / direction, or 0

  explicit WalkRay(const Ray<double>& ray) {
    for (int a = 0; a < 3; ++a) {
      origin[a] = ray.origin[a];
      direction[a] = ray.direction[a];
      inverse[a] = direction[a] != 0 ? 1 / direction[a] : 0;
    }
  }
};

/// The planes between the cells of three axes, in tables.
class WalkPlanes {
 public:
  explicit WalkPlanes(const GridAxis<double> (&axis)[3]) {
    for (int a = 0; a < 3; ++a) {
      std::vector<double>& list = list_[a];
      for (int i = 0; i <= axis[a].cells(); ++i) list.push_back(axis[a].plane(i));
      // Planes of uniform axes are guessed, those of others are searched from the first on.
      const double width = list.size() > 2 ? list[2] - list[1] : list.back() - list.front();
      per_length_[a] = axis[a].plane_position == nullptr ? 1 / width : 0;
    }
  }
  /// Takes the planes of blocks of `width` cells instead, whose planes are nearly uniform.
  WalkPlanes(const GridAxis<double> (&axis)[3], double width) : WalkPlanes(axis) {
    for (int a = 0; a < 3; ++a) per_length_[a] = 1 / width;
  }

  const double* operator[](int a) const { return list_[a].data(); }
  int cells(int a) const { return static_cast<int>(list_[a].size()) - 1; }
  /// Returns the cell from `first` to `last` that contains a position, or the nearest one.
  int find(int a, double position, int first, int last) const {
    const double* const plane = list_[a].data();
    const double guess = (position - plane[first]) * per_length_[a];
    int cell = std::clamp(first + static_cast<int>(std::clamp(guess, 0.0, 1e9)), first, last);
    while (cell > first && plane[cell] > position) --cell;
    while (cell < last && plane[cell + 1] <= position) ++cell;
    return cell;
  }

 private:
  std::vector<double> list_[3];
  double per_length_[3];
};

/// Walks through cells, or through blocks as if they were cells. Its intervals tile the
/// range, like those of StructuredWalk; but positions of planes are off by a few roundings, so that
/// a cell may begin beside its plane by that much. Projections account for it. No division on the
/// way.
class AxisWalk {
 public:
  struct Step {
    int cell[3];
    double begin, end;  ///< begin < end
  };

  /// Goes no farther than the cells from `first` to `last`. All must outlive the walk.
  AxisWalk(const WalkPlanes& planes, const WalkRay& ray, Interval<double> range,
           const int (&first)[3], const int (&last)[3])
      : ray_(ray), t_(range.begin), end_(range.end) {
    for (int a = 0; a < 3; ++a) {
      plane_[a] = planes[a];
      const double position = ray.origin[a] + t_ * ray.direction[a];
      cell_[a] = planes.find(a, position, first[a], last[a]);
      const bool up = ray.direction[a] > 0;
      step_[a] = up ? 1 : -1;
      ahead_[a] = up ? 1 : 0;
      left_[a] = up ? last[a] - cell_[a] : cell_[a] - first[a];
      meet(a);
    }
    skip();
  }

  bool next(Step& step) {
    if (!(t_ < end_)) return false;
    for (int b = 0; b < 3; ++b) step.cell[b] = cell_[b];
    step.begin = t_;
    step.end = t_ = std::min(std::min(next_[0], next_[1]), std::min(next_[2], end_));
    if (t_ < end_) skip();
    return true;
  }

 private:
  /// Goes on behind all planes that the ray has reached: past cells that it only touches.
  void skip() {
    for (int a = 0; a < 3; ++a) {
      while (next_[a] <= t_) advance(a);
    }
  }
  void advance(int a) {
    if (left_[a] == 0) {
      next_[a] = std::numeric_limits<double>::infinity();
      return;
    }
    --left_[a];
    cell_[a] += step_[a];
    meet(a);
  }
  void meet(int a) {
    next_[a] = ray_.direction[a] == 0
                   ? std::numeric_limits<double>::infinity()
                   : (plane_[a][cell_[a] + ahead_[a]] - ray_.origin[a]) * ray_.inverse[a];
  }

  const WalkRay& ray_;
  const double* plane_[3];
  double t_, end_;
  int cell_[3], step_[3], ahead_[3], left_[3];
  double next_[3];
};

}  // namespace pellucid
