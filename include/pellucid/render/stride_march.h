// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/render/ray_integrator.h"
#include "pellucid/traverse/curvature_bounds.h"

namespace pellucid {

/// Marches through consecutive smooth blocks in strides as long as the tolerance allows, and cell
/// by cell elsewhere.
class StrideMarch {
 public:
  /// Prepares for a ray. `direction` is the ray's direction per world length, in grid coordinates.
  /// `least_width` and `mean_width` are the smallest and the mean cell width along each axis.
  PELLUCID_HD StrideMarch(Vec3<double> direction, Vec3<double> least_width,
                          Vec3<double> mean_width) noexcept
      : direction_(direction), least_width_(least_width) {
    double square = 0;  // cells per world length
    for (int a = 0; a < 3; ++a) {
      square += (direction[a] / mean_width[a]) * (direction[a] / mean_width[a]);
    }
    // Not a whole number of cells: along an axis or a diagonal all samples would have the same
    // position in their cells, and a common error would not show in the difference of two rules.
    shortest_ = 2.2 / sqrt(square);
    length_ = shortest_;
  }

  /// Returns the length of the shortest stride; half of it is about a cell.
  PELLUCID_HD double shortest() const noexcept { return shortest_; }

  /// Returns whether positions at this distance from the eye are accurate to a billionth of a
  /// stride.
  PELLUCID_HD bool resolves_positions(double t) const noexcept {
    return 8 * rounding_unit<double> * t <= 1e-9 * shortest_;
  }
  /// Returns the largest length that is worth collecting before run().
  PELLUCID_HD double longest() const noexcept { return 16 * shortest_; }
  /// Returns the variation of the data's derivative on half of the shortest stride.
  PELLUCID_HD double variation(const CurvatureBounds& curvature) const noexcept {
    return derivative_variation(curvature, direction_, least_width_, 0.5 * shortest_);
  }

  /// Integrates from t.begin to t.end; each_cell(Interval) integrates an interval cell by cell.
  template <class Integrator, class EachCell>
  PELLUCID_HD void run(Integrator& integrator, Interval<double> t, const CurvatureBounds& curvature,
                       EachCell&& each_cell) noexcept {
    double here = t.begin, value = 0;
    bool known = false;
    while (here < t.end && !integrator.done()) {
      const double left = t.end - here;
      // No short remainder is left.
      const double length = left < 1.5 * length_ ? left : length_;
      if (left < 0.5 * shortest_) {
        each_cell({here, t.end});
        return;
      }
      if (!known) value = integrator.sample(here);
      known = true;
      const double variation =
          derivative_variation(curvature, direction_, least_width_, 0.5 * length);
      double back;
      if (integrator.try_stride(here, length, variation, value, back)) {
        here = length == left ? t.end : here + length;
        value = back;
        pause_ = 2;
        if (length >= length_) length_ = min(2 * length_, 64 * shortest_);
        continue;
      }
      if (length_ > shortest_) {
        length_ = max(0.5 * length_, shortest_);
        continue;
      }
      // A failed stride is likely to fail again: the distance to the next try grows each time.
      const double pause = pause_ * shortest_;
      const double end = left < pause + shortest_ ? t.end : here + pause;
      each_cell({here, end});
      here = end;
      known = false;
      pause_ = min(4 * pause_, 256.0);
    }
  }

 private:
  Vec3<double> direction_, least_width_;
  double shortest_, length_;
  double pause_ = 2;  ///< in units of the shortest stride
};

}  // namespace pellucid
