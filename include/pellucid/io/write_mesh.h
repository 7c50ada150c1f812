// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "pellucid/scene/unstructured_grid.h"

namespace pellucid {

/// Writes VTK's XML file of unstructured grids (.vtu), uncompressed, with all arrays in their own
/// types: whole or not at all. Names are made UTF-8 without control characters. Throws Error where
/// the grid does not agree with itself, has Lagrange cells or polyhedra, or the file cannot be
/// written.
void write_vtu(const UnstructuredGrid& grid, const std::filesystem::path& path);

/// The cells of a volume's grid as tetrahedra (to_unstructured(), tetrahedralize()). Throws Error
/// where memory does not hold them.
UnstructuredGrid volume_tetrahedra(const Volume& volume, const ParallelFor& parallel = {});

}  // namespace pellucid
