// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "pellucid/field/trilinear.h"
#include "pellucid/geometry/affine.h"

namespace pellucid {

/// Distances from a data value to its neighbors along an axis; 0 where there is none.
struct NeighborDistances {
  double before, behind;
};

/// Returns the distances of the data value with this index, in grid coordinates.
PELLUCID_HD inline NeighborDistances neighbor_distances(const GridAxis<double>& axis,
                                                        int value) noexcept {
  const auto position = [&](int index) noexcept { return axis.plane(index + axis.padding); };
  return {value > 0 ? position(value) - position(value - 1) : 0,
          value + 1 < axis.values ? position(value + 1) - position(value) : 0};
}

/// Returns the derivative along an axis at a value with what is before and behind it, which may be
/// NaN: that of the parabola through the three; one-sided where there is no neighbor.
PELLUCID_HD inline double neighbor_derivative(const NeighborDistances& apart, double before,
                                              double value, double behind) noexcept {
  const bool has_before = apart.before > 0 && !is_nan(before);
  const bool has_behind = apart.behind > 0 && !is_nan(behind);
  const double first = has_before ? (value - before) / apart.before : 0;
  const double second = has_behind ? (behind - value) / apart.behind : 0;
  if (!has_before) return second;
  if (!has_behind) return first;
  // Slopes of the two sides, weighted by the distance on the other side: the parabola's.
  return (apart.behind * first + apart.before * second) / (apart.before + apart.behind);
}

/// Gradients at the corners of a cell by the grid coordinates, in the order of CellCorners.
struct CornerGradients {
  Vec3<double> at[8];
};

/// Returns the gradients of GradientKind::smooth (scene/light.h). apart(axis, value): the
/// neighbor_distances() of the data value with this index.
template <class Value, class Apart>
PELLUCID_HD CornerGradients smooth_gradients(const StructuredGrid<Value, double>& grid,
                                             const int (&cell)[3], Apart&& apart) noexcept {
  CornerGradients result;
  const std::ptrdiff_t stride[3] = {1, grid.axis[0].values,
                                    std::ptrdiff_t{grid.axis[0].values} * grid.axis[1].values};
  for (int n = 0; n < 8; ++n) {
    int index[3];
    for (int a = 0; a < 3; ++a) index[a] = grid.axis[a].value_index(cell[a] + (n >> a & 1));
    const Value* const here = grid.data + grid.offset(index[0], index[1], index[2]);
    const double value = static_cast<double>(*here);
    for (int a = 0; a < 3; ++a) {
      const NeighborDistances far = apart(a, index[a]);
      constexpr double none = std::numeric_limits<double>::quiet_NaN();
      result.at[n][a] =
          neighbor_derivative(far, far.before > 0 ? static_cast<double>(here[-stride[a]]) : none,
                              value, far.behind > 0 ? static_cast<double>(here[stride[a]]) : none);
    }
  }
  return result;
}

/// Returns the gradients of GradientKind::field.
template <class Value>
PELLUCID_HD CornerGradients field_gradients(const StructuredGrid<Value, double>& grid,
                                            const int (&cell)[3]) noexcept {
  const CellCorners<double> v = grid.template corners<double>(cell[0], cell[1], cell[2]);
  CornerGradients result;
  for (int a = 0; a < 3; ++a) {
    const double width = grid.axis[a].plane(cell[a] + 1) - grid.axis[a].plane(cell[a]);
    for (int n = 0; n < 8; ++n) {
      result.at[n][a] = (v.value[n | 1 << a] - v.value[n & ~(1 << a)]) / width;
    }
  }
  return result;
}

/// Computes the world components of the gradients along the way from entry to exit of the cell.
/// `grid_from_world`: the matrix of the map.
PELLUCID_HD inline void gradients_along(const CornerGradients& corners,
                                        const Mat3<double>& grid_from_world,
                                        const Vec3<double>& entry, const Vec3<double>& exit,
                                        CubicBernstein<double> (&gradient)[3]) noexcept {
  for (int a = 0; a < 3; ++a) {
    CellCorners<double> component;
    for (int n = 0; n < 8; ++n) {
      component.value[n] = dot(grid_from_world.column[a], corners.at[n]);
    }
    gradient[a] = trilinear_cubic(component, entry, exit);
  }
}

/// Returns the magnitudes of the gradients at the corners, in the world.
PELLUCID_HD inline CellCorners<double> corner_magnitudes(
    const CornerGradients& corners, const Mat3<double>& grid_from_world) noexcept {
  CellCorners<double> size;
  for (int n = 0; n < 8; ++n) {
    const Vec3<double> world{dot(grid_from_world.column[0], corners.at[n]),
                             dot(grid_from_world.column[1], corners.at[n]),
                             dot(grid_from_world.column[2], corners.at[n])};
    size.value[n] = length(world);
  }
  return size;
}

/// Computes the magnitude of the gradients at the corners, trilinear between, along that way.
PELLUCID_HD inline CubicBernstein<double> magnitude_along(const CornerGradients& corners,
                                                          const Mat3<double>& grid_from_world,
                                                          const Vec3<double>& entry,
                                                          const Vec3<double>& exit) noexcept {
  return trilinear_cubic(corner_magnitudes(corners, grid_from_world), entry, exit);
}

/// Returns the gradient at a place in the cell, in the world.
PELLUCID_HD inline Vec3<double> gradient_at(const CornerGradients& corners,
                                            const Mat3<double>& grid_from_world,
                                            const Vec3<double>& local) noexcept {
  Vec3<double> in_grid, world;
  for (int a = 0; a < 3; ++a) {
    CellCorners<double> component;
    for (int n = 0; n < 8; ++n) component.value[n] = corners.at[n][a];
    in_grid[a] = trilinear_value(component, local);
  }
  for (int a = 0; a < 3; ++a) world[a] = dot(grid_from_world.column[a], in_grid);
  return world;
}

/// Returns the magnitude at a place, trilinear between those at the corners.
PELLUCID_HD inline double magnitude_at(const CornerGradients& corners,
                                       const Mat3<double>& grid_from_world,
                                       const Vec3<double>& local) noexcept {
  return trilinear_value(corner_magnitudes(corners, grid_from_world), local);
}

}  // namespace pellucid
