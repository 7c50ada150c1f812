// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "pellucid/scene/tetrahedralize.h"

namespace pellucid::test_overlapping_cells {
namespace {

// Hexahedra whose points 2 and 3 are exchanged, as in voxels: the cells are twisted.
TEST(OverlappingCells, AreCountedAndNamed) {
  UnstructuredGrid grid;
  for (int cell = 0; cell < 5; ++cell) {
    for (int i = 0; i < 8; ++i) {
      grid.corners.push_back(static_cast<std::int32_t>(grid.points.size()));
      const int j = cell >= 3 && i % 4 >= 2 ? i ^ 1 : i;
      grid.points.push_back({3.0 * cell + ((j + 1) / 2 % 2), 1.0 * (j / 2 % 2), 1.0 * (j / 4)});
    }
    grid.shapes.push_back(CellShape::hexahedron);
  }
  grid.arrays.push_back({"c", Centering::cell, 1, DataArray<float>(5)});
  const std::vector<MeshArrayChoice> choices{{"c", {}, {}}};
  MeshStatistics s = cut_into_tetrahedra(grid, choices)->mesh().statistics();
  EXPECT_EQ(s.cells, 5U);
  EXPECT_EQ(s.overlapping_cells, 2U);
  EXPECT_EQ(s.first_overlapping_cell, 3);
  EXPECT_GT(s.folded_faces, 0U);
  grid.cell_numbers = {10, 20, 30, 41, 40};
  s = cut_into_tetrahedra(grid, choices)->mesh().statistics();
  EXPECT_EQ(s.first_overlapping_cell, 40);
  // Mirrored cells are the same cells.
  for (Vec3<double>& p : grid.points) p.x = -p.x;
  grid.corners.resize(3 * 8);
  grid.shapes.resize(3);
  grid.cell_numbers.clear();
  grid.arrays = {{"c", Centering::cell, 1, DataArray<float>(3)}};
  s = cut_into_tetrahedra(grid, choices)->mesh().statistics();
  EXPECT_EQ(s.overlapping_cells, 0U);
  EXPECT_EQ(s.first_overlapping_cell, -1);
}

}  // namespace
}  // namespace pellucid::test_overlapping_cells
