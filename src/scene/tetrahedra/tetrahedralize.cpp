// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "cut_arrays.h"
#include "pellucid/scene/cut_cells.h"

namespace pellucid {

UnstructuredGrid tetrahedralize(const UnstructuredGrid& grid, const ParallelFor& parallel) {
  const bool with_cells = std::ranges::any_of(
      grid.arrays, [](const MeshArray& array) { return array.centering == Centering::cell; });
  CellCut cut = cut_cells(grid, with_cells, parallel);

  UnstructuredGrid tetrahedra;
  tetrahedra.name = grid.name;
  tetrahedra.arrays.reserve(grid.arrays.size());
  for (const MeshArray& array : grid.arrays) {
    tetrahedra.arrays.push_back(
        {array.name, array.centering, array.components, carried(grid, array, cut)});
  }
  tetrahedra.points = std::move(cut.points);
  tetrahedra.shapes.assign(cut.tetrahedra.size(), CellShape::tetrahedron);
  tetrahedra.corners.reserve(4 * cut.tetrahedra.size());
  for (const auto& corners : cut.tetrahedra) {
    tetrahedra.corners.insert(tetrahedra.corners.end(), corners.begin(), corners.end());
  }
  return tetrahedra;
}

}  // namespace pellucid
