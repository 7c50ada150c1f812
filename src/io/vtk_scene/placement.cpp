// SPDX-License-Identifier: Apache-2.0
#include "placement.h"

#include <cmath>

#include "pellucid/scene/error.h"

namespace pellucid::vtk_scene {

Affine<double> affine_of(const Matrix& matrix, const std::string& what) {
  const auto at = [&](std::size_t row, std::size_t column) { return matrix[4 * row + column]; };
  Affine<double> affine;
  for (std::size_t c = 0; c < 3; ++c) {
    affine.matrix.column[c] = {at(0, c), at(1, c), at(2, c)};
  }
  affine.translation = {at(0, 3), at(1, 3), at(2, 3)};
  for (std::size_t c = 0; c < 4; ++c) {
    if (at(3, c) != (c == 3 ? 1 : 0)) {
      throw Error(what + ": its matrix is not affine; take one whose last row is 0 0 0 1");
    }
  }
  if (!(std::abs(determinant(affine.matrix)) > 0)) {
    throw Error(what + ": its matrix is singular; take one that can be inverted");
  }
  return affine;
}

GridPlacement placement_of(const ImageSettings& image, bool of_cells) {
  GridPlacement placement;
  placement.origin = image.origin;
  placement.direction = image.direction;
  double spacing[] = {image.spacing.x, image.spacing.y, image.spacing.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Vec3<double>& direction = placement.direction.column[axis];
    placement.origin = placement.origin + direction * (spacing[axis] * image.first[axis]);
    if (spacing[axis] < 0) {
      spacing[axis] = -spacing[axis];
      direction = -direction;
    }
    if (of_cells) placement.origin = placement.origin + direction * (spacing[axis] / 2);
  }
  placement.spacing = {spacing[0], spacing[1], spacing[2]};
  return placement;
}

}  // namespace pellucid::vtk_scene
