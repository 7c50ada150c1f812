// SPDX-License-Identifier: Apache-2.0
#include "grid_gradient.h"

#include <cstddef>

namespace pellucid {

GridGradient::GridGradient(const Volume& volume, GradientKind kind) : volume_(volume), kind_(kind) {
  volume.visit([&](const auto& grid) {
    for (int a = 0; a < 3; ++a) {
      const auto& axis = grid.axis[a];
      for (int i = 0; i < axis.values; ++i) neighbors_[a].push_back(neighbor_distances(axis, i));
    }
  });
}

CornerGradients GridGradient::smooth_corners(const int (&cell)[3]) const {
  return volume_.visit([&](const auto& grid) {
    return smooth_gradients(grid, cell, [&](int axis, int value) {
      return neighbors_[axis][static_cast<std::size_t>(value)];
    });
  });
}

void GridGradient::along(const StructuredWalk<double>::Step& step,
                         CubicBernstein<double> (&gradient)[3]) const {
  const CornerGradients corners =
      kind_ == GradientKind::smooth
          ? smooth_corners(step.cell)
          : volume_.visit([&](const auto& grid) { return field_gradients(grid, step.cell); });
  gradients_along(corners, volume_.grid_from_world().matrix, step.entry, step.exit, gradient);
}

CubicBernstein<double> GridGradient::magnitude_along(
    const StructuredWalk<double>::Step& step) const {
  return pellucid::magnitude_along(smooth_corners(step.cell), volume_.grid_from_world().matrix,
                                   step.entry, step.exit);
}

}  // namespace pellucid
