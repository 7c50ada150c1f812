// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "mixed_mesh.h"
#include "pellucid/scene/tetrahedralize.h"
#include "quadratic_mesh.h"
#include "tetrahedra_check.h"

namespace pellucid::test_tetrahedralized_meshes {
namespace {

/// The tetrahedra fill the box from 0 to `size`, without a gap or an overlap, and have no face in
/// common that is not between two of them.
void expect_box(const TetrahedraCheck& check, const UnstructuredGrid& tetrahedra, double size,
                std::size_t boundary_faces) {
  EXPECT_FALSE(check.crowded());
  EXPECT_EQ(check.euler_characteristic(), 1);
  EXPECT_EQ(check.six_volumes, 6 * size * size * size);
  const std::vector<Triangle> boundary = check.boundary();
  EXPECT_EQ(boundary.size(), boundary_faces);
  const auto on_side = [&](const Triangle& t) {
    for (int a = 0; a < 3; ++a) {
      for (const double plane : {0.0, size}) {
        if (std::ranges::all_of(t, [&](std::int32_t p) {
              return tetrahedra.points[static_cast<std::size_t>(p)][a] == plane;
            })) {
          return true;
        }
      }
    }
    return false;
  };
  EXPECT_TRUE(std::ranges::all_of(boundary, on_side));
}

TEST(TetrahedralizedMeshes, OfLinearCellsHaveNoCracks) {
  for (const bool collapsed : {false, true}) {
    for (unsigned seed = 0; seed < 40; ++seed) {
      SCOPED_TRACE((collapsed ? "collapsed, seed " : "seed ") + std::to_string(seed));
      const int n = 1 + static_cast<int>(seed % 4);
      const MixedMesh mixed(n, seed, collapsed);
      const UnstructuredGrid tetrahedra = tetrahedralize(mixed.grid());
      const TetrahedraCheck check(tetrahedra);
      expect_box(check, tetrahedra, n * MixedMesh::side, static_cast<std::size_t>(12 * n * n));
      EXPECT_GT(check.smallest, 0);
    }
  }
}

TEST(TetrahedralizedMeshes, OfQuadraticCellsHaveNoCracks) {
  for (const bool middles : {false, true}) {
    for (unsigned seed = 0; seed < 24; ++seed) {
      SCOPED_TRACE((middles ? "with middles, seed " : "seed ") + std::to_string(seed));
      const int n = 1 + static_cast<int>(seed % 3);
      const double size = n * MixedMesh::side;
      const MixedMesh mixed(n, seed, false);
      const QuadraticMesh quadratic(mixed.grid(), size, 40, middles, seed);
      const UnstructuredGrid tetrahedra = tetrahedralize(quadratic.grid());
      const TetrahedraCheck check(tetrahedra);
      expect_box(check, tetrahedra, size, static_cast<std::size_t>(48 * n * n));
      EXPECT_GT(check.smallest, 0);
    }
  }
}

TEST(TetrahedralizedMeshes, HaveNoFoldedFaces) {
  const MixedMesh mixed(3, 5, true);
  UnstructuredGrid grid = mixed.grid();
  grid.arrays.push_back({"x", Centering::point, 1, DataArray<float>(grid.points.size())});
  const std::vector<MeshArrayChoice> choices{{"x", {}, {}}};
  const MeshStatistics s = cut_into_tetrahedra(grid, choices)->mesh().statistics();
  EXPECT_EQ(s.folded_faces, 0U);
  EXPECT_EQ(s.degenerate, 0U);
  EXPECT_EQ(s.boundary_faces, 12U * 9U);
}

// Whether the work is split or not; thousands of cells are.
TEST(TetrahedralizedMeshes, AreTheSameInParallel) {
  const MixedMesh mixed(12, 3, true);
  UnstructuredGrid grid = mixed.grid();
  std::vector<std::int32_t> numbers(grid.shapes.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<std::int32_t>(i);
  grid.arrays.push_back({"cell", Centering::cell, 1, numbers});
  const UnstructuredGrid once = tetrahedralize(grid);
  const UnstructuredGrid split =
      tetrahedralize(grid, [](int count, const std::function<void(int, int)>& body) {
        EXPECT_GT(count, 1);
        for (int i = count; i-- > 0;) body(i, i + 1);
      });
  EXPECT_EQ(once.corners, split.corners);
  EXPECT_TRUE(std::get<DataArray<std::int32_t>>(once.arrays[0].values) ==
              std::get<DataArray<std::int32_t>>(split.arrays[0].values));
}

}  // namespace
}  // namespace pellucid::test_tetrahedralized_meshes
