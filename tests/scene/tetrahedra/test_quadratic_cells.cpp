// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

#include "pellucid/scene/tetrahedralize.h"
#include "quadratic_mesh.h"
#include "tetrahedra_check.h"

namespace pellucid::test_quadratic_cells {
namespace {

struct Linear {
  const char* what;
  CellShape shape;
  std::vector<Vec3<double>> points;
  double six_volumes;
  std::size_t fewest, most;  ///< tetrahedra that the quadratic cell becomes
  std::size_t new_points;
};

/// Affine images of the unit cells.
std::vector<Linear> affine_cells() {
  const auto at = [](double x, double y, double z) {
    return Vec3<double>{8 * (x + y), 8 * (2 * y - z), 8 * (x + z)};  // determinant 8³
  };
  const double unit = 6 * 512;
  return {{"tetrahedron",
           CellShape::tetrahedron,
           {at(0, 0, 0), at(1, 0, 0), at(0, 1, 0), at(0, 0, 1)},
           unit / 6,
           8,
           8,
           0},
          {"pyramid",
           CellShape::pyramid,
           {at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0), at(0, 0, 1)},
           unit / 3,
           16,
           16,
           1},
          {"wedge",
           CellShape::wedge,
           {at(0, 0, 0), at(1, 0, 0), at(0, 1, 0), at(0, 0, 1), at(1, 0, 1), at(0, 1, 1)},
           unit / 2,
           24,
           24,
           3},
          {"hexahedron",
           CellShape::hexahedron,
           {at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0), at(0, 0, 1), at(1, 0, 1),
            at(1, 1, 1), at(0, 1, 1)},
           unit,
           40,
           48,
           7}};
}

UnstructuredGrid linear_grid(const Linear& cell) {
  UnstructuredGrid grid;
  grid.points = cell.points;
  grid.shapes = {cell.shape};
  grid.corners.resize(cell.points.size());
  std::iota(grid.corners.begin(), grid.corners.end(), 0);
  return grid;
}

// Of straight edges, quadratic cells fill what the linear ones do.
TEST(QuadraticCells, OfStraightEdgesAreTheLinearOnes) {
  for (const Linear& cell : affine_cells()) {
    for (const bool middles : {false, true}) {
      SCOPED_TRACE(cell.what);
      const QuadraticMesh mesh(linear_grid(cell), 0, 0, middles, 0);
      const UnstructuredGrid tetrahedra = tetrahedralize(mesh.grid());
      const TetrahedraCheck check(tetrahedra);
      EXPECT_EQ(check.six_volumes, cell.six_volumes);
      EXPECT_GT(check.smallest, 0);
      EXPECT_GE(check.tetrahedra, cell.fewest);
      EXPECT_LE(check.tetrahedra, cell.most);
      EXPECT_EQ(check.euler_characteristic(), 1);
      EXPECT_EQ(check.boundary().size(),
                4 * TetrahedraCheck(tetrahedralize(linear_grid(cell))).boundary().size());
      const bool complete = mesh.grid().shapes[0] == CellShape::biquadratic_wedge ||
                            mesh.grid().shapes[0] == CellShape::triquadratic_hexahedron;
      EXPECT_EQ(tetrahedra.points.size(),
                mesh.grid().points.size() + (complete ? 0 : cell.new_points));
      // Where edges are straight the new points are the means of the corners around them.
      Vec3<double> mean;
      for (const Vec3<double>& p : cell.points) mean = mean + p;
      mean = mean * (1.0 / static_cast<double>(cell.points.size()));
      if (cell.shape == CellShape::hexahedron) {
        EXPECT_TRUE(tetrahedra.points[26] == mean);
      }
    }
  }
}

// However edges are bent: what is linear in the coordinates at the nodes is so at the new points.
TEST(QuadraticCells, ReproduceLinearFields) {
  const auto field = [](const Vec3<double>& p) { return 3 * p.x - 5 * p.y + 2 * p.z + 7; };
  for (const Linear& cell : affine_cells()) {
    for (unsigned seed = 0; seed < 8; ++seed) {
      SCOPED_TRACE(cell.what);
      // As if it lay inside of a box: all edges are bent.
      UnstructuredGrid linear = linear_grid(cell);
      for (Vec3<double>& p : linear.points) p = p * 64.0 + Vec3<double>{1024, 1024, 1024};
      QuadraticMesh mesh(linear, 1e6, 200, false, seed);
      UnstructuredGrid grid = mesh.grid();
      std::vector<double> values;
      std::vector<std::int16_t> vectors;
      for (const Vec3<double>& p : grid.points) {
        values.push_back(field(p));
        for (int a = 0; a < 3; ++a) vectors.push_back(static_cast<std::int16_t>(p[a]));
      }
      grid.arrays.push_back({"field", Centering::point, 1, values});
      grid.arrays.push_back({"place", Centering::point, 3, vectors});
      const UnstructuredGrid tetrahedra = tetrahedralize(grid);
      ASSERT_EQ(tetrahedra.points.size(), grid.points.size() + cell.new_points);
      const auto& found = std::get<DataArray<double>>(tetrahedra.arrays[0].values);
      ASSERT_EQ(found.size(), tetrahedra.points.size());
      for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found[i], field(tetrahedra.points[i]));
      }
      if (cell.new_points == 0) continue;
      // Whole numbers become fractions.
      const auto& places = std::get<DataArray<float>>(tetrahedra.arrays[1].values);
      for (std::size_t i = 0; i < found.size(); ++i) {
        for (std::size_t a = 0; a < 3; ++a) {
          EXPECT_EQ(static_cast<double>(places[3 * i + a]),
                    tetrahedra.points[i][static_cast<int>(a)]);
        }
      }
    }
  }
}

// The 8-node quadrilateral has x² y at its middle where its nodes have it (x² y is among its
// functions); the 20-node hexahedron so x² y z.
TEST(QuadraticCells, MiddlesAreThoseOfTheShapeFunctions) {
  const Linear cube{"hexahedron",
                    CellShape::hexahedron,
                    {{8, 8, 8},
                     {24, 8, 8},
                     {24, 24, 8},
                     {8, 24, 8},
                     {8, 8, 24},
                     {24, 8, 24},
                     {24, 24, 24},
                     {8, 24, 24}},
                    0,
                    0,
                    0,
                    7};
  UnstructuredGrid grid = QuadraticMesh(linear_grid(cube), 0, 0, false, 0).grid();
  const auto field = [](const Vec3<double>& p) { return p.x * p.x * p.y * p.z; };
  std::vector<double> values;
  values.reserve(grid.points.size());
  for (const Vec3<double>& p : grid.points) values.push_back(field(p));
  grid.arrays.push_back({"field", Centering::point, 1, values});
  const UnstructuredGrid tetrahedra = tetrahedralize(grid);
  const auto& found = std::get<DataArray<double>>(tetrahedra.arrays[0].values);
  ASSERT_EQ(found.size(), 27U);
  for (std::size_t i = 20; i < 27; ++i) EXPECT_EQ(found[i], field(tetrahedra.points[i])) << i;
}

}  // namespace
}  // namespace pellucid::test_quadratic_cells
