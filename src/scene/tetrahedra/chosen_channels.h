// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pellucid/scene/tetrahedralize.h"
#include "tetrahedralized_cells.h"

namespace pellucid {

/// Throws Error where an array is missing, before hours are spent on the cells.
void check_choices(const UnstructuredGrid& grid, std::span<const MeshArrayChoice> choices);

/// Cuts the cells of a grid, with TetrahedralizedCells::cell, and puts the tetrahedra in spatial
/// order.
TetrahedralizedCells ordered_tetrahedra(const UnstructuredGrid& grid, const ParallelFor& parallel);

/// Returns the chosen arrays at the points or the tetrahedra of such cells.
std::vector<MeshChannel> chosen_channels(const UnstructuredGrid& grid,
                                         std::span<const MeshArrayChoice> choices,
                                         const TetrahedralizedCells& cells);

/// Returns the cell numbers of the file, or those by order: a cell without a tetrahedron counts
/// too.
std::vector<std::int32_t> numbers_of_cells(const UnstructuredGrid& grid);

}  // namespace pellucid
