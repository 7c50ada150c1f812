// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "pellucid/scene/tetrahedralize.h"
#include "tetrahedra_arrays.h"

namespace pellucid {

UnstructuredGrid tetrahedralize(const UnstructuredGrid& grid, const ParallelFor& parallel) {
  const bool with_cells = std::ranges::any_of(
      grid.arrays, [](const MeshArray& array) { return array.centering == Centering::cell; });
  TetrahedralizedCells cells = tetrahedralize_cells(grid, with_cells, parallel);

  UnstructuredGrid tetrahedra;
  tetrahedra.name = grid.name;
  tetrahedra.arrays.reserve(grid.arrays.size());
  for (const MeshArray& array : grid.arrays) {
    tetrahedra.arrays.push_back(
        {array.name, array.centering, array.components, carried(grid, array, cells)});
  }
  tetrahedra.points = std::move(cells.points);
  tetrahedra.shapes.assign(cells.tetrahedra.size(), CellShape::tetrahedron);
  tetrahedra.corners.reserve(4 * cells.tetrahedra.size());
  for (const auto& corners : cells.tetrahedra) {
    tetrahedra.corners.insert(tetrahedra.corners.end(), corners.begin(), corners.end());
  }
  return tetrahedra;
}

}  // namespace pellucid
