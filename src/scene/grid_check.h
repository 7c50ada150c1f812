// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pellucid/scene/unstructured_grid.h"

namespace pellucid {

/// Throws Error with the grid's name in front.
[[noreturn]] void fail(const UnstructuredGrid& grid, const std::string& message);

/// Throws Error where there is no cell, the corners are not as many as the shapes want, or one is
/// out of range.
void check_cells(const UnstructuredGrid& grid);

/// Throws Error where an array has no component or not one value for each point or cell.
void check_array(const UnstructuredGrid& grid, const MeshArray& array);

}  // namespace pellucid
