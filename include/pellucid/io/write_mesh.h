// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "pellucid/scene/unstructured_grid.h"

namespace pellucid {

/// Writes an unstructured grid as uncompressed VTK XML (.vtu) with all arrays in their own types,
/// complete or not at all. Names become UTF-8 without control characters. Throws Error if the grid
/// is inconsistent or has Lagrange cells or polyhedra, or the file cannot be written.
void write_vtu(const UnstructuredGrid& grid, const std::filesystem::path& path);

/// Returns the cells of a volume's grid as tetrahedra (to_unstructured(), tetrahedralize()). Throws
/// Error if memory does not suffice.
UnstructuredGrid volume_tetrahedra(const Volume& volume, const ParallelFor& parallel = {});

}  // namespace pellucid
