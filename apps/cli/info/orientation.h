// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pellucid/geometry/affine.h"

namespace pellucid::cli {

/// Orientation of the axes of a grid in a patient, in a world of LPS (x towards left, y towards
/// posterior, z towards superior).
struct Orientation {
  std::string code;       ///< where each index grows to, e.g. "LPS", "RAS", "PIR"
  double oblique_by = 0;  ///< degrees: largest angle between an axis and the direction named
};

/// Each axis is named by the world direction it is nearest to, the nearest pair first, no world
/// axis twice. The columns need not have length 1 but are not zero.
Orientation anatomical_orientation(const Mat3<double>& direction);

}  // namespace pellucid::cli
