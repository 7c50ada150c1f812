// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/geometry/ray.h"
#include "pellucid/scene/clip.h"
#include "pellucid/scene/layer.h"

namespace pellucid {

/// The parts of a ray that clips keep.
///
/// Positions are computed in long double from the clips' own numbers and rounded once. Errors grow
/// where a ray grazes a surface; `uncertain` has them.
struct ClipIntervals {
  /// A position at which a clip cuts the ray, and the largest error of it, in world length.
  struct Uncertain {
    double t, error;
  };
  std::vector<Interval<double>> kept;  ///< disjoint, front to back, within `range`
  std::vector<Uncertain> uncertain;

  /// Leaves of the range of the ray, whose direction has length 1, what all of the clips keep.
  ClipIntervals(Interval<double> range, const std::vector<Clip>& clips, const Ray<double>& ray);

  /// Returns the total error of the positions in the range, each at most the range's length.
  double error_in(Interval<double> range) const noexcept;

 private:
  void cut(const Clip& clip, const Ray<double>& ray);
};

/// Returns the clips of a layer and of its scene.
std::vector<Clip> clips_of(const Layer& layer, const std::vector<Clip>& of_scene);

}  // namespace pellucid
