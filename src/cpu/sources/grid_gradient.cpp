// SPDX-License-Identifier: Apache-2.0
#include "grid_gradient.h"

#include <cstddef>

#include "pellucid/geometry/vec3.h"

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

CornerGradients GridGradient::corners(const int (&cell)[3]) const {
  return kind_ == GradientKind::smooth
             ? smooth_corners(cell)
             : volume_.visit([&](const auto& grid) { return field_gradients(grid, cell); });
}

void GridGradient::along(const StructuredWalk<double>::Step& step,
                         CubicBernstein<double> (&gradient)[3]) const {
  gradients_along(corners(step.cell), volume_.grid_from_world().matrix, step.entry, step.exit,
                  gradient);
}

Vec3<double> GridGradient::at(const GridPlace<double>& place) const {
  return gradient_at(corners(place.cell), volume_.grid_from_world().matrix, place.local);
}

double GridGradient::magnitude_at(const GridPlace<double>& place) const {
  return pellucid::magnitude_at(smooth_corners(place.cell), volume_.grid_from_world().matrix,
                                place.local);
}

double GridGradient::doubt(const StructuredWalk<double>::Step& step,
                           const GridAxis<double> (&axis)[3], const PlaneAmbiguity& planes,
                           const CubicBernstein<double> (&gradient)[3]) const {
  if (kind_ == GradientKind::smooth) return 0;
  double largest = 0;
  planes.for_each_other_cell(axis, step, [&](const int(&cell)[3]) {
    StructuredWalk<double>::Step other = step;
    for (int a = 0; a < 3; ++a) {
      other.cell[a] = cell[a];
      // On the plane between both.
      if (cell[a] != step.cell[a]) other.entry[a] = other.exit[a] = cell[a] < step.cell[a] ? 1 : 0;
    }
    CubicBernstein<double> there[3];
    along(other, there);
    for (int k = 0; k < 4; ++k) {
      Vec3<double> jump;
      for (int a = 0; a < 3; ++a) jump[a] = there[a].b[k] - gradient[a].b[k];
      // NaN: vacuum.
      if (const double size = length(jump); size > largest) largest = size;
    }
  });
  return largest;
}

bool GridGradient::is_doubtful(const StructuredWalk<double>::Step& step,
                               const GridAxis<double> (&axis)[3],
                               const PlaneAmbiguity& planes) const {
  bool has_other = false;
  if (kind_ != GradientKind::smooth) {
    planes.for_each_other_cell(axis, step, [&](const int(&)[3]) { has_other = true; });
  }
  return has_other;
}

CubicBernstein<double> GridGradient::magnitude_along(
    const StructuredWalk<double>::Step& step) const {
  return pellucid::magnitude_along(smooth_corners(step.cell), volume_.grid_from_world().matrix,
                                   step.entry, step.exit);
}

}  // namespace pellucid
