// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "pellucid/base/config.h"
#include "pellucid/geometry/ray.h"
#include "pellucid/math/exponential.h"

namespace pellucid {

/// What is known of the place where half of a ray's opacity is reached: it lies in this stretch of
/// it, world arc length, and so much of the opacity in front of that.
struct HalfOpacity {
  Interval<double> range{0, std::numeric_limits<double>::infinity()};
  double opacity_before = 0;

  /// The optical depth of the stretch from its begin to where half of this opacity is reached; >=
  /// 0. At the half exp(-a) = 1 - opacity/2.
  PELLUCID_HD double depth_to_half(double opacity) const noexcept {
    const double depth = log1p(-opacity_before) - log1p(-0.5 * opacity);
    return depth > 0 ? depth : 0;
  }
};

}  // namespace pellucid
