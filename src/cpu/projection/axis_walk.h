// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "pellucid/field/structured_grid.h"
#include "pellucid/geometry/ray.h"
#include "pellucid/traverse/block_record.h"

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

/// Walks through cells, or through blocks as if they were cells. Its intervals tile the range, like
/// those of StructuredWalk; but positions of planes are off by a few roundings, so that a cell may
/// begin beside its plane by that much. Projections account for it. Half as many divisions.
class AxisWalk {
 public:
  struct Step {
    int cell[3];
    double begin, end;  ///< begin < end
  };

  /// `block`: null, or the block (8³ cells of the axes) in which the range lies.
  AxisWalk(const GridAxis<double> (&axis)[3], const WalkRay& ray, Interval<double> range,
           const int* block)
      : axis_(axis), ray_(ray), t_(range.begin), end_(range.end) {
    for (int a = 0; a < 3; ++a) {
      int first = 0, last = axis_[a].cells() - 1;
      if (block != nullptr) {
        first = std::min(block[a] * block_width, last);
        last = std::min(first + block_width - 1, last);
      }
      first_[a] = first;
      last_[a] = last;
      const double position = ray.origin[a] + t_ * ray.direction[a];
      cell_[a] = std::clamp(find_cell(axis_[a], position), first, last);
      meet(a);
    }
  }

  bool next(Step& step) {
    if (!(t_ < end_)) return false;
    int a = nearest();
    for (; next_[a] <= t_; a = nearest()) {
      if (!advance(a)) next_[a] = std::numeric_limits<double>::infinity();
    }
    for (int b = 0; b < 3; ++b) step.cell[b] = cell_[b];
    step.begin = t_;
    step.end = t_ = std::min(next_[a], end_);
    return true;
  }

 private:
  int nearest() const {
    const int a = next_[1] < next_[0] ? 1 : 0;
    return next_[2] < next_[a] ? 2 : a;
  }
  /// Goes on to the next cell along an axis; false behind the last one.
  bool advance(int a) {
    const bool up = ray_.direction[a] > 0;
    if (cell_[a] == (up ? last_[a] : first_[a])) return false;
    cell_[a] += up ? 1 : -1;
    meet(a);
    return true;
  }
  void meet(int a) {
    if (ray_.direction[a] == 0) {
      next_[a] = std::numeric_limits<double>::infinity();
      return;
    }
    const int plane = cell_[a] + (ray_.direction[a] > 0 ? 1 : 0);
    next_[a] = (axis_[a].plane(plane) - ray_.origin[a]) * ray_.inverse[a];
  }

  const GridAxis<double> (&axis_)[3];
  const WalkRay& ray_;
  double t_, end_;
  int cell_[3], first_[3], last_[3];
  double next_[3];
};

}  // namespace pellucid
