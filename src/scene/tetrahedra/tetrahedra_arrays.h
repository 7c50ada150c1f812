// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/scene/mesh_channels.h"
#include "pellucid/scene/tetrahedralize.h"
#include "tetrahedralized_cells.h"

namespace pellucid {

/// Returns an array of the grid, all its components, at the points or the tetrahedra of its cells
/// (whose TetrahedralizedCells::cell is there where the array is centred on cells).
VolumeData carried(const UnstructuredGrid& grid, const MeshArray& array,
                   const TetrahedralizedCells& cells);

/// Returns the array that a choice names: of points, where points and cells have one. Throws Error
/// where there is none, or it has no such component.
const MeshArray& chosen_array(const UnstructuredGrid& grid, const MeshArrayChoice& choice);

/// Returns the chosen part of the array, at the points or the tetrahedra of the cells.
MeshChannel chosen_channel(const UnstructuredGrid& grid, const MeshArrayChoice& choice,
                           const TetrahedralizedCells& cells);

}  // namespace pellucid
