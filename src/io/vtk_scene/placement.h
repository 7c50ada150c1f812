// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include "pellucid/geometry/affine.h"
#include "pellucid/scene/volume.h"
#include "settings.h"

namespace pellucid::vtk_scene {

/// Returns an affine matrix of VTK. Throws Error for others, which `what` begins.
Affine<double> affine_of(const Matrix& matrix, const std::string& what);

/// A vtkImageData without its values.
struct ImageSettings {
  Vec3<double> origin{}, spacing{1, 1, 1};
  std::array<int, 3> first{};  ///< of the extent along each axis
  Mat3<double> direction{};
};
/// Returns its place with spacings above 0. Values of cells lie in the middle of the cells.
GridPlacement placement_of(const ImageSettings& image, bool of_cells);

}  // namespace pellucid::vtk_scene
