// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "added_points.h"
#include "pellucid/scene/unstructured_grid.h"

namespace pellucid {

/// The tetrahedra of a grid's cells, and where each comes from.
struct TetrahedralizedCells {
  std::vector<Vec3<double>> points;
  /// Which they are, of the grid's and then the new ones; empty: in that order.
  std::vector<std::int32_t> numbers;
  std::vector<std::array<std::int32_t, 4>> tetrahedra;
  std::vector<std::int32_t> cell;  ///< of each tetrahedron; empty unless asked for
  AddedPoints added;               ///< the new points; looks into the grid
};

/// Cuts the cells of a grid. `with_cells`: TetrahedralizedCells::cell is wanted. Throws Error where
/// the grid does not agree with itself, or the tetrahedra are more than a mesh can have.
TetrahedralizedCells tetrahedralize_cells(const UnstructuredGrid& grid, bool with_cells,
                                          const ParallelFor& parallel);

}  // namespace pellucid
