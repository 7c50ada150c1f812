// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/field/trilinear.h"

namespace pellucid {

/// A place in a grid: a cell, and where in [0,1]³ of it.
template <class T>
struct GridPlace {
  int cell[3]{};
  Vec3<T> local{};
};

/// Returns the place of a position in grid coordinates, clamped into the box.
template <class T>
PELLUCID_HD GridPlace<T> place_in_grid(const GridAxis<double> (&axis)[3],
                                       Vec3<double> position_grid) noexcept {
  GridPlace<T> place;
  for (int a = 0; a < 3; ++a) {
    place.cell[a] = find_cell(axis[a], position_grid[a]);
    const double lower = axis[a].plane(place.cell[a]);
    const double width = axis[a].plane(place.cell[a] + 1) - lower;
    place.local[a] = static_cast<T>(clamp((position_grid[a] - lower) / width, 0.0, 1.0));
  }
  return place;
}

/// Returns the trilinear value at a place; NaN in a cell with a NaN corner, even a corner of
/// weight 0.
template <class T, class Value>
PELLUCID_HD T sample_value(const StructuredGrid<Value, double>& grid,
                           const GridPlace<T>& place) noexcept {
  return trilinear_value(grid.template corners<T>(place.cell[0], place.cell[1], place.cell[2]),
                         place.local);
}

/// Returns the same at a position in grid coordinates, clamped into the box.
template <class T, class Value>
PELLUCID_HD T sample_value(const StructuredGrid<Value, double>& grid,
                           Vec3<double> position_grid) noexcept {
  return sample_value<T>(grid, place_in_grid<T>(grid.axis, position_grid));
}

}  // namespace pellucid
