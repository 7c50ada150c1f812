// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pellucid/geometry/affine.h"

namespace pellucid::cli {

/// Orientation of the axes of a grid in a patient, in a world of LPS (x towards left, y towards
/// posterior, z towards superior).
struct Orientation {
  std::string code;       ///< where each index grows to, e.g. "LPS", "RAS", "PIR"
  double oblique_by = 0;  ///< degrees: largest angle between an axis and its direction
};

/// Returns the letters and the tilt of the index axes, of which column i is axis i in the world, of
/// any length but 0. Each is named by the world direction that it is nearest to, the nearest pair
/// first, no world axis twice.
Orientation anatomical_orientation(const Mat3<double>& direction);

}  // namespace pellucid::cli
