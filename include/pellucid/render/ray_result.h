// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "pellucid/math/rgb.h"

namespace pellucid {

/// What one ray gathers. Accumulated in double whatever the kernels' number type: thousands of
/// cells in binary32 would cost more than the kernels do (specification, 2.3).
struct RayResult {
  Rgb<double> radiance{};  ///< premultiplied
  double opacity = 0;
  double optical_depth = 0;
  /// World arc length at which half of the opacity is reached; infinite where the ray stays clear
  /// or the depth was not asked for.
  double half_opacity_depth = std::numeric_limits<double>::infinity();
  long cells = 0;  ///< cells walked through, or samples taken
};

}  // namespace pellucid
