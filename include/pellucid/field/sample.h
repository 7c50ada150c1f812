// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/field/trilinear.h"

namespace pellucid {

/// Returns the trilinear value at a position in grid coordinates, clamped into the box; NaN in a
/// cell with a NaN corner, even a corner of weight 0.
template <class T, class Value>
PELLUCID_HD T sample_value(const StructuredGrid<Value, double>& grid,
                           Vec3<double> position_grid) noexcept {
  int cell[3];
  Vec3<T> local;
  for (int a = 0; a < 3; ++a) {
    cell[a] = find_cell(grid.axis[a], position_grid[a]);
    const double lower = grid.axis[a].plane(cell[a]);
    const double width = grid.axis[a].plane(cell[a] + 1) - lower;
    local[a] = static_cast<T>(clamp((position_grid[a] - lower) / width, 0.0, 1.0));
  }
  return trilinear_value(grid.template corners<T>(cell[0], cell[1], cell[2]), local);
}

}  // namespace pellucid
