// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "lagrange_mesh.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/tetrahedralize.h"
#include "tetrahedra_check.h"

namespace pellucid::test_lagrange_cells {
namespace {

template <class Call>
std::string error_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

constexpr double side = 7200;  // of many orders a multiple

UnstructuredGrid one_cell(CellShape shape) {
  UnstructuredGrid grid;
  const std::vector<Vec3<double>> hexahedron{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                             {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  const std::vector<std::size_t> of =
      shape == CellShape::tetrahedron ? std::vector<std::size_t>{0, 1, 3, 4}
      : shape == CellShape::wedge     ? std::vector<std::size_t>{0, 1, 3, 4, 5, 7}
                                      : std::vector<std::size_t>{0, 1, 2, 3, 4, 5, 6, 7};
  for (const std::size_t i : of) {
    grid.points.push_back(hexahedron[i] * side);
    grid.corners.push_back(static_cast<std::int32_t>(grid.corners.size()));
  }
  grid.shapes = {shape};
  return grid;
}

struct Known {
  const char* what;
  CellShape shape;
  Lattice lattice;
  double share;  ///< of the cube
  std::size_t fewest, most, boundary;
};

std::vector<Known> known_cells() {
  return {{"tetrahedron of order 4", CellShape::tetrahedron, tetrahedron_of_order_4(), 1.0 / 6, 64,
           64, 4 * 16},
          {"tetrahedron of order 5", CellShape::tetrahedron, tetrahedron_of_order_5(), 1.0 / 6, 125,
           125, 4 * 25},
          {"wedge", CellShape::wedge, wedge_of_orders_4_and_3(), 0.5, 3 * 48, 3 * 48,
           2 * 16 + 3 * 2 * 12},
          {"hexahedron", CellShape::hexahedron, hexahedron_of_orders_3_2_and_4(), 1, 5 * 24, 6 * 24,
           4 * (6 + 8 + 12)}};
}

// Nodes in VTK's order give the cell that its corners span; in any other order parts of it would
// lie upon each other.
TEST(LagrangeCells, TakesNodesInTheOrderOfVtk) {
  for (const Known& known : known_cells()) {
    SCOPED_TRACE(known.what);
    const LagrangeMesh mesh(
        one_cell(known.shape), [&](CellShape) { return known.lattice; }, side, 0, 0);
    const UnstructuredGrid tetrahedra = tetrahedralize(mesh.grid());
    const TetrahedraCheck check(tetrahedra);
    EXPECT_EQ(tetrahedra.points.size(), known.lattice.size());
    EXPECT_NEAR(check.six_volumes, 6 * known.share * side * side * side, 1);
    EXPECT_GT(check.smallest, 0);
    EXPECT_GE(check.tetrahedra, known.fewest);
    EXPECT_LE(check.tetrahedra, known.most);
    EXPECT_EQ(check.euler_characteristic(), 1);
    EXPECT_EQ(check.boundary().size(), known.boundary);
    EXPECT_EQ(check.points.size(), known.lattice.size());
  }
}

// Orders 1 and 2 are the linear and quadratic cells.
TEST(LagrangeCells, OfLowOrderAreTheOthers) {
  const std::vector<std::pair<CellShape, CellShape>> linear{
      {CellShape::lagrange_tetrahedron, CellShape::tetrahedron},
      {CellShape::lagrange_wedge, CellShape::wedge},
      {CellShape::lagrange_hexahedron, CellShape::hexahedron}};
  const std::vector<std::pair<CellShape, CellShape>> quadratic{
      {CellShape::lagrange_tetrahedron, CellShape::quadratic_tetrahedron},
      {CellShape::lagrange_wedge, CellShape::biquadratic_wedge},
      {CellShape::lagrange_hexahedron, CellShape::triquadratic_hexahedron}};
  const auto sorted = [](const UnstructuredGrid& grid) {
    std::vector<std::vector<std::int32_t>> list;
    for (std::size_t t = 0; t < grid.corners.size(); t += 4) {
      const auto begin = grid.corners.begin() + static_cast<std::ptrdiff_t>(t);
      list.emplace_back(begin, begin + 4);
      std::ranges::sort(list.back());
    }
    std::ranges::sort(list);
    return list;
  };
  std::mt19937 random(3);
  for (const int order : {1, 2}) {
    for (const auto& [lagrange, plain] : order == 1 ? linear : quadratic) {
      const int count = lagrange_points(lagrange, {order, order, order});
      ASSERT_EQ(count, point_count(plain));
      for (int round = 0; round < 20; ++round) {
        UnstructuredGrid grid;
        grid.shapes = {plain};
        for (int i = 0; i < count; ++i) {
          grid.corners.push_back(i);
          const auto any = [&] { return static_cast<double>(random() % 1000); };
          grid.points.push_back({any(), any(), any()});
        }
        std::ranges::shuffle(grid.corners, random);
        const auto expected = sorted(tetrahedralize(grid));
        grid.shapes = {lagrange};
        grid.layouts = {count, order, order, order};
        EXPECT_EQ(sorted(tetrahedralize(grid)), expected) << count;
      }
    }
  }
}

// Quadratic cells with a node in the middle of triangles and of themselves.
TEST(LagrangeCells, WithMiddlesAreFilled) {
  const Lattice tetrahedron{{0, 0, 0}, {12, 0, 0}, {0, 12, 0}, {0, 0, 12}, {6, 0, 0},
                            {6, 6, 0}, {0, 6, 0},  {0, 0, 6},  {6, 0, 6},  {0, 6, 6},
                            {4, 4, 0}, {4, 0, 4},  {4, 4, 4},  {0, 4, 4},  {3, 3, 3}};
  const Lattice wedge{{0, 0, 0}, {12, 0, 0}, {0, 12, 0}, {0, 0, 12}, {12, 0, 12}, {0, 12, 12},
                      {6, 0, 0}, {6, 6, 0},  {0, 6, 0},  {6, 0, 12}, {6, 6, 12},  {0, 6, 12},
                      {0, 0, 6}, {12, 0, 6}, {0, 12, 6}, {4, 4, 0},  {4, 4, 12},  {6, 0, 6},
                      {6, 6, 6}, {0, 6, 6},  {4, 4, 6}};
  for (const bool is_wedge : {false, true}) {
    SCOPED_TRACE(is_wedge);
    UnstructuredGrid grid;
    for (const auto& at : is_wedge ? wedge : tetrahedron) {
      grid.corners.push_back(static_cast<std::int32_t>(grid.points.size()));
      grid.points.push_back({1.0 * at[0], 1.0 * at[1], 1.0 * at[2]});
    }
    grid.shapes = {is_wedge ? CellShape::lagrange_wedge : CellShape::lagrange_tetrahedron};
    grid.layouts = {static_cast<std::int32_t>(grid.points.size()), 2, 2, 2};
    const UnstructuredGrid tetrahedra = tetrahedralize(grid);
    const TetrahedraCheck check(tetrahedra);
    EXPECT_EQ(check.six_volumes, (is_wedge ? 3.0 : 1.0) * 12 * 12 * 12);
    EXPECT_GT(check.smallest, 0);
    EXPECT_EQ(check.points.size(), grid.points.size());
    EXPECT_EQ(check.euler_characteristic(), 1);
    // Of a triangle three at the corners and three around its middle; of a quadrilateral eight.
    EXPECT_EQ(check.boundary().size(), is_wedge ? 2U * 6 + 3 * 8 : 4U * 6);
    EXPECT_EQ(check.tetrahedra, is_wedge ? 2U * 6 * 3 : 4U + 4 + 12);
  }
}

/// Columns of hexahedra and of pairs of wedges, n of each along each axis.
UnstructuredGrid columns(int n) {
  UnstructuredGrid grid;
  for (int k = 0; k <= n; ++k) {
    for (int j = 0; j <= n; ++j) {
      for (int i = 0; i <= n; ++i) grid.points.push_back({i * side, j * side, k * side});
    }
  }
  const auto at = [&](int i, int j, int k) { return i + (n + 1) * (j + (n + 1) * k); };
  const auto add = [&](CellShape shape, const std::vector<std::int32_t>& points) {
    grid.shapes.push_back(shape);
    grid.corners.insert(grid.corners.end(), points.begin(), points.end());
  };
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const std::vector<std::int32_t> c{
            at(i, j, k),     at(i + 1, j, k),     at(i + 1, j + 1, k),     at(i, j + 1, k),
            at(i, j, k + 1), at(i + 1, j, k + 1), at(i + 1, j + 1, k + 1), at(i, j + 1, k + 1)};
        if ((i + j) % 2 == 0) {
          add(CellShape::hexahedron, c);
        } else {
          add(CellShape::wedge, {c[0], c[1], c[2], c[4], c[5], c[6]});
          add(CellShape::wedge, {c[2], c[3], c[0], c[6], c[7], c[4]});
        }
      }
    }
  }
  return grid;
}

/// The places of the nodes of any order, written down list by list as VTK's books describe them.
Lattice hexahedron_lattice(int order) {
  Lattice nodes{{0, 0, 0}, {order, 0, 0}, {order, order, 0}, {0, order, 0}};
  for (std::size_t i = 0; i < 4; ++i) nodes.push_back({nodes[i][0], nodes[i][1], order});
  for (const int k : {0, order}) {
    for (int i = 1; i < order; ++i) nodes.push_back({i, 0, k});
    for (int j = 1; j < order; ++j) nodes.push_back({order, j, k});
    for (int i = 1; i < order; ++i) nodes.push_back({i, order, k});
    for (int j = 1; j < order; ++j) nodes.push_back({0, j, k});
  }
  for (std::size_t corner = 0; corner < 4; ++corner) {
    for (int k = 1; k < order; ++k) nodes.push_back({nodes[corner][0], nodes[corner][1], k});
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t fast = axis == 0 ? 1 : 0, slow = axis == 2 ? 1 : 2;
    for (const int at : {0, order}) {
      for (int s = 1; s < order; ++s) {
        for (int f = 1; f < order; ++f) {
          std::array<int, 3> node{};
          node[axis] = at;
          node[fast] = f;
          node[slow] = s;
          nodes.push_back(node);
        }
      }
    }
  }
  for (int k = 1; k < order; ++k) {
    for (int j = 1; j < order; ++j) {
      for (int i = 1; i < order; ++i) nodes.push_back({i, j, k});
    }
  }
  return nodes;
}

Lattice wedge_lattice(int order) {
  Lattice nodes{{0, 0, 0}, {order, 0, 0}, {0, order, 0}};
  for (std::size_t i = 0; i < 3; ++i) nodes.push_back({nodes[i][0], nodes[i][1], order});
  for (const int k : {0, order}) {
    for (int i = 1; i < order; ++i) nodes.push_back({i, 0, k});
    for (int j = 1; j < order; ++j) nodes.push_back({order - j, j, k});
    for (int j = order - 1; j > 0; --j) nodes.push_back({0, j, k});
  }
  for (std::size_t corner = 0; corner < 3; ++corner) {
    for (int k = 1; k < order; ++k) nodes.push_back({nodes[corner][0], nodes[corner][1], k});
  }
  const auto triangle = [&](int k) {
    for (int j = 1; j < order; ++j) {
      for (int i = 1; i + j < order; ++i) nodes.push_back({i, j, k});
    }
  };
  triangle(0);
  triangle(order);
  for (int side_of = 0; side_of < 3; ++side_of) {
    for (int k = 1; k < order; ++k) {
      for (int s = 1; s < order; ++s) {
        nodes.push_back(side_of == 0   ? std::array{s, 0, k}
                        : side_of == 1 ? std::array{order - s, s, k}
                                       : std::array{0, order - s, k});
      }
    }
  }
  for (int k = 1; k < order; ++k) triangle(k);
  return nodes;
}

// Cells of both kinds side by side, with bent edges and faces: no gap and no overlap.
TEST(LagrangeCells, HaveNoCracks) {
  for (const int order : {1, 2, 3, 4, 5}) {
    for (unsigned seed = 0; seed < 4; ++seed) {
      SCOPED_TRACE("order " + std::to_string(order) + ", seed " + std::to_string(seed));
      const int n = order < 4 ? 3 : 2;
      const LagrangeMesh mesh(
          columns(n),
          [&](CellShape shape) {
            return shape == CellShape::wedge ? wedge_lattice(order) : hexahedron_lattice(order);
          },
          n * side, static_cast<int>(side) / (8 * order), seed);
      const UnstructuredGrid tetrahedra = tetrahedralize(mesh.grid());
      const TetrahedraCheck check(tetrahedra);
      EXPECT_FALSE(check.crowded());
      EXPECT_EQ(check.euler_characteristic(), 1);
      EXPECT_GT(check.smallest, 0);
      const double box = n * side;
      EXPECT_NEAR(check.six_volumes / (6 * box * box * box), 1, 1e-12);
      EXPECT_EQ(check.boundary().size(), static_cast<std::size_t>(6 * 2 * n * n * order * order));
    }
  }
}

// Tetrahedra of order 4 around the diagonal of a cube.
TEST(LagrangeCells, OfTetrahedraHaveNoCracks) {
  UnstructuredGrid linear;
  for (int i = 0; i < 8; ++i) {
    linear.points.push_back({side * (i & 1), side * (i >> 1 & 1), side * (i >> 2)});
  }
  for (const auto& t : {std::array{0, 1, 3, 7}, std::array{0, 3, 2, 7}, std::array{0, 2, 6, 7},
                        std::array{0, 6, 4, 7}, std::array{0, 4, 5, 7}, std::array{0, 5, 1, 7}}) {
    linear.shapes.push_back(CellShape::tetrahedron);
    linear.corners.insert(linear.corners.end(), t.begin(), t.end());
  }
  for (unsigned seed = 0; seed < 4; ++seed) {
    for (const bool fifth : {false, true}) {
      const LagrangeMesh mesh(
          linear,
          [&](CellShape) { return fifth ? tetrahedron_of_order_5() : tetrahedron_of_order_4(); },
          side, 100, seed);
      const UnstructuredGrid tetrahedra = tetrahedralize(mesh.grid());
      const TetrahedraCheck check(tetrahedra);
      EXPECT_FALSE(check.crowded());
      EXPECT_EQ(check.euler_characteristic(), 1);
      EXPECT_NEAR(check.six_volumes / (6 * side * side * side), 1, 1e-12);
      EXPECT_EQ(check.boundary().size(), fifth ? 12U * 25 : 12U * 16);
      EXPECT_GT(check.smallest, 0);
    }
  }
}

TEST(LagrangeCells, RefusesLayoutsThatDoNotFit) {
  UnstructuredGrid grid;
  grid.points.resize(27);
  grid.shapes = {CellShape::lagrange_hexahedron};
  grid.corners.resize(27);
  std::iota(grid.corners.begin(), grid.corners.end(), 0);
  const auto error = [&](const std::vector<std::int32_t>& layouts) {
    grid.layouts = layouts;
    return error_of([&] { tetrahedralize(grid); });
  };
  EXPECT_NE(error({}).find("layout"), std::string::npos);
  EXPECT_NE(error({27, 2, 2}).find("layout"), std::string::npos);
  EXPECT_NE(error({27, 2, 2, 3}).find("does not have 27 points"), std::string::npos);
  EXPECT_NE(error({-27, 2, 2, 2}).find("points"), std::string::npos);
  EXPECT_NE(error({27, 2, 2, 2, 5}).find("more layouts"), std::string::npos);
  EXPECT_NE(error({2147483647, 2000, 2000, 2000}).find("does not have"), std::string::npos);
  EXPECT_NE(error({36, 2, 2, 3}).find("36 corners"), std::string::npos);
  grid.cell_numbers = {70};
  EXPECT_NE(error({27, 0, 2, 3}).find("cell 70"), std::string::npos);
  grid.cell_numbers = {1, 2};
  EXPECT_NE(error({27, 2, 2, 2}).find("2 numbers for 1 cells"), std::string::npos);
}

}  // namespace
}  // namespace pellucid::test_lagrange_cells
