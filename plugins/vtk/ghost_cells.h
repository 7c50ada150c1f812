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

#include "settings.h"
#include "vtk_scene/ghost_cells.h"
#include "vtk_scene/kept.h"

class vtkDataSet;

namespace pellucid::plugin {

/// Returns whether data are an image or a rectilinear grid.
bool is_grid(vtkDataSet& data);
/// Returns the number of cells along each axis of an image or a rectilinear grid.
std::array<int, 3> cells_along(vtkDataSet& data);

/// Flags of ghosts, the time of their last change, and the sides of their grid in cells.
using GhostRecipe =
    std::tuple<vtkSmartPointer<vtkUnsignedCharArray>, vtkMTimeType, std::array<int, 3>>;
using KeptOwnCells = Kept<GhostRecipe, OwnCells>;

/// Returns the ghost cells of an image or a rectilinear grid; none if it has no flags of cells. The
/// data are asked for points as long as they live.
std::optional<GhostCells> ghosts_of(vtkDataSet& data, KeptOwnCells& kept);

/// Returns the box around the own cells of an image or a rectilinear grid, in the world of its
/// data; invalid if all are ghosts.
vtkBoundingBox own_bounds(vtkDataSet& data, KeptOwnCells& kept);

/// Flags of the ghosts at points and of cells, null if there are none, and when they changed last.
struct GhostTimes {
  std::array<vtkSmartPointer<vtkUnsignedCharArray>, 2> flags;
  std::array<vtkMTimeType, 2> times{};

  bool operator==(const GhostTimes&) const = default;
};
GhostTimes ghost_times(vtkDataSet& data);
/// Returns which values of an image or a rectilinear grid are hidden, as
/// vtk_scene::hidden_places(). Throws Error.
std::vector<bool> hidden_places(vtkDataSet& data, bool of_cells);

}  // namespace pellucid::plugin
