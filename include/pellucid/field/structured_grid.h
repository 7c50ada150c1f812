// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "pellucid/geometry/vec3.h"

namespace pellucid {

/// One axis of a structured grid in the grid's own coordinates. Planes 0 … cells bound the cells 0
/// … cells-1; plane i has the data value `value_index(i)`.
///
///   point-centred, n values:  planes at 0, 1, …, n-1                      (n-1 cells)
///   cell-centred,  n values:  planes at -½, 0, 1, …, n-1, n-½             (n+1 cells)
///
/// Cell-centred data have their values at the centres; the outer half cells repeat the border
/// value, so that the box is that of the cells. On a rectilinear axis `plane_position` lists the
/// planes.
template <class T>
struct GridAxis {
  const T* plane_position = nullptr;  ///< cells + 1 numbers, strictly ascending; null: uniform
  int values = 0;                     ///< data values along the axis
  int padding = 0;                    ///< 0 point-centred, 1 cell-centred

  PELLUCID_HD constexpr int cells() const noexcept { return values - 1 + 2 * padding; }
  /// Returns the position of plane i.
  PELLUCID_HD constexpr T plane(int i) const noexcept {
    if (plane_position != nullptr) return plane_position[i];
    return clamp(T(i - padding), T(-0.5), T(values) - T(0.5));
  }
  /// Returns the index of the data value on a plane.
  PELLUCID_HD constexpr int value_index(int plane) const noexcept {
    return clamp(plane - padding, 0, values - 1);
  }
};

/// Returns the cell that contains a position: the upper one on a plane between two, the border cell
/// outside of the grid.
template <class T>
PELLUCID_HD inline int find_cell(const GridAxis<T>& axis, T position) noexcept {
  const int last = axis.cells() - 1;
  if (axis.plane_position == nullptr) {
    return static_cast<int>(clamp(floor(position) + T(axis.padding), T(0), T(last)));
  }
  int lo = 0, hi = last + 1;
  while (hi - lo > 1) {
    const int mid = lo + (hi - lo) / 2;
    (axis.plane_position[mid] <= position ? lo : hi) = mid;
  }
  return lo;
}

/// The eight data values around a cell, x fastest: V000, V100, V010, V110, V001, V101, V011, V111.
template <class T>
struct CellCorners {
  T value[8];
};

/// A structured grid with data of type Value, as trilinear cells. A view; owns nothing. T is the
/// number type of positions, not of the data.
template <class Value, class T>
struct StructuredGrid {
  const Value* data = nullptr;  ///< x fastest
  GridAxis<T> axis[3];

  /// Returns the index of data value (i, j, k).
  PELLUCID_HD std::ptrdiff_t offset(int i, int j, int k) const noexcept {
    return i + static_cast<std::ptrdiff_t>(axis[0].values) *
                   (j + static_cast<std::ptrdiff_t>(axis[1].values) * k);
  }

  /// Returns the corners of cell (i, j, k), converted to Number.
  template <class Number>
  PELLUCID_HD CellCorners<Number> corners(int i, int j, int k) const noexcept {
    const int x[2] = {axis[0].value_index(i), axis[0].value_index(i + 1)};
    const int y[2] = {axis[1].value_index(j), axis[1].value_index(j + 1)};
    const int z[2] = {axis[2].value_index(k), axis[2].value_index(k + 1)};
    CellCorners<Number> c;
    for (int n = 0; n < 8; ++n) {
      c.value[n] = static_cast<Number>(data[offset(x[n & 1], y[(n >> 1) & 1], z[n >> 2])]);
    }
    return c;
  }
};

}  // namespace pellucid
