// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "pellucid/scene/unstructured_grid.h"

namespace pellucid {

/// Throws Error with the grid's name in front.
[[noreturn]] void fail(const UnstructuredGrid& grid, const std::string& message);

/// Returns the number by which messages call a cell.
std::int32_t cell_number(const UnstructuredGrid& grid, std::size_t cell);

/// Throws Error where there is no cell, corners or layouts are not what the shapes want, a corner
/// is out of range, or the faces of a polyhedron do not close.
void check_cells(const UnstructuredGrid& grid);

/// Throws Error where an array has no component or not one value for each point or cell.
void check_array(const UnstructuredGrid& grid, const MeshArray& array);

}  // namespace pellucid
