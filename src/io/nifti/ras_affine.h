// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "pellucid/geometry/vec3.h"
#include "pellucid/scene/volume.h"

namespace pellucid {

/// Rows of a map from indices to a world of RAS (x towards right, y anterior, z superior).
using RasRows = std::array<std::array<double, 4>, 3>;

/// Returns the placement of the map, its world turned to LPS. Columns without a length give a
/// direction of NaN.
inline GridPlacement placement_from_ras(const RasRows& rows) {
  GridPlacement placement;
  placement.origin = {-rows[0][3], -rows[1][3], rows[2][3]};
  for (int a = 0; a < 3; ++a) {
    const auto column = static_cast<std::size_t>(a);
    const Vec3<double> axis{-rows[0][column], -rows[1][column], rows[2][column]};
    placement.spacing[a] = length(axis);
    placement.direction.column[a] = axis * (1 / placement.spacing[a]);
  }
  return placement;
}

}  // namespace pellucid
