// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vtkBoundingBox.h>
#include <vtkSmartPointer.h>
#include <vtkType.h>
#include <vtkUnsignedCharArray.h>

#include <array>
#include <optional>
#include <tuple>
#include <vector>

#include "kept.h"
#include "pellucid/geometry/affine.h"
#include "pellucid/scene/clip.h"

class vtkDataSet;

namespace pellucid::plugin {

/// Returns whether data are an image or a rectilinear grid.
bool is_grid(vtkDataSet& data);
/// Returns the number of cells along each axis of an image or a rectilinear grid.
std::array<int, 3> cells_along(vtkDataSet& data);

/// The cells of a grid that are no ghosts.
struct OwnCells {
  std::array<int, 3> first{}, last{};  ///< of the box around them, in cells along each axis
  vtkIdType count = 0;
};
/// Flags of ghosts, the time of their last change, and the sides of their grid in cells.
using GhostRecipe =
    std::tuple<vtkSmartPointer<vtkUnsignedCharArray>, vtkMTimeType, std::array<int, 3>>;
using KeptOwnCells = Kept<GhostRecipe, OwnCells>;

/// Returns the planes around the cells of an image or a rectilinear grid that are its own, in the
/// world; nothing if all are ghosts. The ghost cells outside of the planes (vtkGhostType:
/// DUPLICATECELL) are another block's or another process's; they are there for values and gradients
/// at the border. A face between cells belongs to those above it: planes lie 2^-20 of a cell below
/// it, so that a surface in the face is shown once. Throws Error if the cells that are no ghosts do
/// not fill a box.
std::optional<std::vector<Clip>> clips_at_ghosts(vtkDataSet& data,
                                                 const Affine<double>& world_from_data,
                                                 KeptOwnCells& kept);

/// Returns the box around the own cells of an image or a rectilinear grid, in the world of its
/// data; invalid if all are ghosts.
vtkBoundingBox own_bounds(vtkDataSet& data, KeptOwnCells& kept);

}  // namespace pellucid::plugin
