// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "pellucid/scene/tetrahedralize.h"
#include "tests/scene/expect_error.h"
#include "tetrahedra_check.h"

namespace pellucid::test_linear_cells {
namespace {

/// A cell of one shape: its points in VTK's order, and its faces, outwards.
struct Cell {
  CellShape shape;
  std::vector<Vec3<double>> points;
  std::vector<std::vector<std::size_t>> faces;
};

// Warped, but not so far that a choice of diagonals turns anything over.
const Cell hexahedron{
    CellShape::hexahedron,
    {{3, -5, 2},
     {101, 4, -6},
     {95, 107, 5},
     {-4, 99, -3},
     {6, 2, 98},
     {97, -7, 104},
     {108, 96, 95},
     {2, 103, 106}},
    {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
const Cell wedge{CellShape::wedge,
                 {{0, 4, 3}, {103, -2, 5}, {5, 98, -4}, {-3, 6, 101}, {98, 3, 95}, {2, 105, 102}},
                 {{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}};
const Cell pyramid{CellShape::pyramid,
                   {{2, -3, 4}, {101, 5, -4}, {97, 104, 6}, {-5, 98, 1}, {47, 55, 120}},
                   {{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};

/// The cell with its k-th point as number numbers[k].
UnstructuredGrid numbered(const Cell& cell, const std::vector<std::int32_t>& numbers) {
  UnstructuredGrid grid;
  grid.points.resize(cell.points.size());
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    grid.points[static_cast<std::size_t>(numbers[k])] = cell.points[k];
  }
  grid.shapes = {cell.shape};
  grid.corners = numbers;
  return grid;
}

/// Cuts the cell with its points numbered in every order. The surface must be the faces cut at
/// their smallest index, the volumes those that the divergence theorem gives for that surface.
void expect_right_in_every_order(const Cell& cell, std::size_t least, std::size_t most) {
  std::vector<std::int32_t> numbers(cell.points.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  do {
    const UnstructuredGrid grid = numbered(cell, numbers);
    const TetrahedraCheck check(tetrahedralize(grid));

    std::vector<Triangle> surface;
    double six_volumes = 0;
    const auto at = [&](std::int32_t i) { return grid.points[static_cast<std::size_t>(i)]; };
    const auto add = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
      six_volumes += dot(at(a), cross(at(b), at(c)));
      Triangle t{a, b, c};
      std::ranges::sort(t);
      surface.push_back(t);
    };
    for (const auto& face : cell.faces) {
      std::vector<std::int32_t> f;
      f.reserve(face.size());
      for (const std::size_t k : face) f.push_back(numbers[k]);
      std::rotate(f.begin(), std::ranges::min_element(f), f.end());
      for (std::size_t i = 2; i < f.size(); ++i) add(f[0], f[i - 1], f[i]);
    }
    std::ranges::sort(surface);

    ASSERT_EQ(check.boundary(), surface) << testing::PrintToString(numbers);
    ASSERT_EQ(check.six_volumes, six_volumes) << testing::PrintToString(numbers);
    ASSERT_GT(check.smallest, 0) << testing::PrintToString(numbers);
    ASSERT_FALSE(check.crowded()) << testing::PrintToString(numbers);
    ASSERT_EQ(check.euler_characteristic(), 1) << testing::PrintToString(numbers);
    ASSERT_GE(check.tetrahedra, least);
    ASSERT_LE(check.tetrahedra, most);
  } while (std::ranges::next_permutation(numbers).found);
}

TEST(LinearCells, HexahedraInEveryOrder) {
  expect_right_in_every_order(hexahedron, 5, 6);
}

TEST(LinearCells, WedgesInEveryOrder) {
  expect_right_in_every_order(wedge, 3, 3);
}

TEST(LinearCells, PyramidsInEveryOrder) {
  expect_right_in_every_order(pyramid, 2, 2);
}

TEST(LinearCells, VoxelsAreHexahedraNumberedXFastest) {
  Cell voxel = hexahedron;
  voxel.shape = CellShape::voxel;
  std::swap(voxel.points[2], voxel.points[3]);
  std::swap(voxel.points[6], voxel.points[7]);
  for (auto& face : voxel.faces) {
    for (std::size_t& k : face) k = k % 4 < 2 ? k : k ^ 1U;
  }
  expect_right_in_every_order(voxel, 5, 6);
}

TEST(LinearCells, TetrahedraStayAsTheyAre) {
  UnstructuredGrid grid;
  grid.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  grid.shapes = {CellShape::tetrahedron, CellShape::tetrahedron};
  grid.corners = {3, 1, 0, 2, 1, 2, 3, 4};
  EXPECT_EQ(tetrahedralize(grid).corners, grid.corners);
}

// A hexahedron with collapsed edges is the wedge, pyramid or tetrahedron that is left.
TEST(LinearCells, CollapsedHexahedra) {
  struct Collapsed {
    const char* what;
    std::vector<std::size_t> same;  ///< by which of them each point is replaced
    double six_volumes;
    std::size_t faces;
  };
  const std::vector<Collapsed> cases{{"wedge", {0, 1, 2, 2, 4, 5, 6, 6}, 3, 8},
                                     {"pyramid", {0, 1, 2, 3, 4, 4, 4, 4}, 2, 6},
                                     {"tetrahedron", {0, 1, 2, 2, 4, 4, 4, 4}, 1, 4},
                                     {"nothing", {0, 1, 2, 3, 0, 1, 2, 3}, 0, 0},
                                     {"one edge", {0, 1, 2, 2, 4, 5, 6, 7}, 0, 10}};
  const std::vector<Vec3<double>> cube{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                       {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  for (const Collapsed& c : cases) {
    std::vector<std::int32_t> numbers(8);
    std::iota(numbers.begin(), numbers.end(), 0);
    do {
      UnstructuredGrid grid = numbered({CellShape::hexahedron, cube, {}}, numbers);
      for (std::size_t k = 0; k < 8; ++k) grid.corners[k] = numbers[c.same[k]];
      const TetrahedraCheck check(tetrahedralize(grid));
      ASSERT_EQ(check.boundary().size(), c.faces) << c.what << testing::PrintToString(numbers);
      ASSERT_FALSE(check.crowded()) << c.what << testing::PrintToString(numbers);
      // A side of it is bent: its volume depends on the diagonal.
      if (std::string(c.what) == "one edge") continue;
      ASSERT_EQ(check.six_volumes, c.six_volumes) << c.what << testing::PrintToString(numbers);
    } while (std::ranges::next_permutation(numbers).found);
  }
}

TEST(LinearCells, RefusesWhatDoesNotFit) {
  const UnstructuredGrid good = numbered(wedge, {0, 1, 2, 3, 4, 5});
  UnstructuredGrid grid = good;
  grid.name = "part.vtu";
  grid.corners[4] = 6;
  expect_error([&] { tetrahedralize(grid); }, {"part.vtu: cell 0 has point 6", "from 0 to 5"});
  grid.corners[4] = -1;
  expect_error([&] { tetrahedralize(grid); }, {"cell 0 has point -1"});
  grid = good;
  grid.shapes.push_back(CellShape::tetrahedron);
  grid.corners.insert(grid.corners.end(), {0, 1, 2, 77});
  expect_error([&] { tetrahedralize(grid); }, {"cell 1 has point 77"});
  grid.corners.pop_back();
  expect_error([&] { tetrahedralize(grid); }, {"need 10 corners, but 9 are there"});
  grid = good;
  grid.shapes.clear();
  grid.corners.clear();
  expect_error([&] { tetrahedralize(grid); }, {"there is no cell"});
}

}  // namespace
}  // namespace pellucid::test_linear_cells
