// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "pellucid/base/config.h"
#include "pellucid/geometry/ray.h"
#include "pellucid/math/exponential.h"

namespace pellucid {

/// Bracket of the position at which half of a ray's opacity is reached: an interval of the ray, in
/// world arc length, and the opacity in front of it.
struct HalfOpacity {
  Interval<double> range{0, std::numeric_limits<double>::infinity()};
  double opacity_before = 0;

  /// Returns the optical depth from the begin of the interval to the position at which half of
  /// `opacity` is reached; >= 0. There exp(-depth) = 1 - opacity/2.
  PELLUCID_HD double depth_to_half(double opacity) const noexcept {
    const double depth = log1p(-opacity_before) - log1p(-0.5 * opacity);
    return depth > 0 ? depth : 0;
  }
};

}  // namespace pellucid
