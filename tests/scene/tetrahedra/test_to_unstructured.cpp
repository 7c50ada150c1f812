// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "pellucid/scene/tetrahedralize.h"
#include "tests/scene/expect_error.h"

namespace pellucid::test_to_unstructured {
namespace {

Volume::Description description(Centering centering) {
  Volume::Description d;
  d.dimensions = {4, 3, 2};
  d.centering = centering;
  d.placement.origin = {10, -20, 30};
  d.placement.spacing = {1, 2, 0.5};
  d.placement.direction.column[0] = {0, 1, 0};
  d.placement.direction.column[1] = {-1, 0, 0};
  d.placement.direction.column[2] = {0, 0, 1};
  return d;
}

std::vector<float> counted(std::size_t count) {
  std::vector<float> values(count);
  std::iota(values.begin(), values.end(), 0.F);
  return values;
}

Vec3<double> point_of(const UnstructuredGrid& grid, std::size_t corner) {
  return grid.points[static_cast<std::size_t>(grid.corners[corner])];
}

TEST(ToUnstructured, PointsStandWhereTheValuesAre) {
  const UnstructuredGrid grid = to_unstructured(Volume(description(Centering::point), counted(24)));
  ASSERT_EQ(grid.points.size(), 24U);
  EXPECT_EQ(grid.shapes.size(), 6U);
  EXPECT_EQ(grid.arrays[0].centering, Centering::point);
  // Index (2, 1, 1): origin + 2 · 1 · column 0 + 1 · 2 · column 1 + 1 · 0.5 · column 2.
  EXPECT_TRUE(grid.points[2 + 4 * (1 + 3)] == (Vec3<double>{8, -18, 30.5}));
  const std::vector<MeshArrayChoice> choices{{"value", {}, {}}};
  const auto channels = cut_into_tetrahedra(grid, choices);
  for (std::size_t p = 0; p < 24; ++p) {
    EXPECT_EQ(channels->value(0, p), channels->mesh().point_number(p));
  }
  EXPECT_DOUBLE_EQ(channels->mesh().statistics().volume, 3 * 4 * 0.5);
  EXPECT_EQ(channels->mesh().statistics().boundary_faces, 2U * 2U * (3 * 2 + 3 * 1 + 2 * 1));
}

TEST(ToUnstructured, CellsHaveTheirValueAtTheirCentre) {
  const Volume::Description d = description(Centering::cell);
  const UnstructuredGrid grid = to_unstructured(Volume(d, counted(24)));
  ASSERT_EQ(grid.points.size(), 5U * 4U * 3U);
  ASSERT_EQ(grid.shapes.size(), 24U);
  EXPECT_EQ(grid.arrays[0].centering, Centering::cell);
  const Volume volume(d, counted(24));
  for (std::size_t cell = 0; cell < 24; ++cell) {
    Vec3<double> sum;
    for (std::size_t k = 0; k < 8; ++k) sum = sum + point_of(grid, 8 * cell + k);
    const Vec3<double> index = volume.grid_from_world().point(sum * 0.125);
    EXPECT_NEAR(index.x + 4 * (index.y + 3 * index.z), static_cast<double>(cell), 1e-9);
  }
}

TEST(ToUnstructured, RectilinearAxesKeepTheirCoordinates) {
  Volume::Description d = description(Centering::cell);
  d.coordinates[0] = {0, 1, 3, 7, 15};
  d.placement = {};
  const UnstructuredGrid grid = to_unstructured(Volume(d, counted(24)));
  EXPECT_EQ(grid.points[3].x, 7);
  EXPECT_EQ(grid.points[5].y, 0.5);
  d.centering = Centering::point;
  d.coordinates[0] = {0, 1, 3, 7};
  EXPECT_EQ(to_unstructured(Volume(d, counted(24))).points[2].x, 3);
}

TEST(HexahedraOfGrid, AreOfVTKsOrder) {
  const std::vector<std::int32_t> corners = grid_hexahedra({3, 2, 2});
  EXPECT_EQ(corners, (std::vector<std::int32_t>{0, 1, 4, 3, 6, 7, 10, 9,  //
                                                1, 2, 5, 4, 7, 8, 11, 10}));
}

TEST(HexahedraOfGrid, RefusesWhatSpansNoCellOrCannotBeCounted) {
  expect_error([] { grid_hexahedra({3, 1, 2}); }, {"3 x 1 x 2 points span no cells"});
  expect_error([] { grid_hexahedra({2000, 2000, 2000}); }, {"more than 2147483647"});
}

}  // namespace
}  // namespace pellucid::test_to_unstructured
