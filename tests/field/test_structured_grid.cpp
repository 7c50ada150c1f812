// SPDX-License-Identifier: Apache-2.0
#include "pellucid/field/structured_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace pellucid::test_structured_grid {
namespace {

TEST(GridAxis, PointCentred) {
  const GridAxis<double> axis{nullptr, 4, 0};
  ASSERT_EQ(axis.cells(), 3);
  for (int i = 0; i <= 3; ++i) {
    EXPECT_EQ(axis.plane(i), i);
    EXPECT_EQ(axis.value_index(i), i);
  }
}

TEST(GridAxis, CellCentredHasHalfCellsOutside) {
  const GridAxis<double> axis{nullptr, 3, 1};
  ASSERT_EQ(axis.cells(), 4);
  const double planes[] = {-0.5, 0, 1, 2, 2.5};
  const int values[] = {0, 0, 1, 2, 2};
  for (int i = 0; i <= 4; ++i) {
    EXPECT_EQ(axis.plane(i), planes[i]);
    EXPECT_EQ(axis.value_index(i), values[i]);
  }
}

TEST(GridAxis, SingleCellCentredValue) {
  const GridAxis<double> axis{nullptr, 1, 1};
  ASSERT_EQ(axis.cells(), 2);
  EXPECT_EQ(axis.plane(0), -0.5);
  EXPECT_EQ(axis.plane(1), 0);
  EXPECT_EQ(axis.plane(2), 0.5);
  EXPECT_EQ(axis.value_index(2), 0);
}

template <class T>
void expect_cells_found(const GridAxis<T>& axis) {
  const T infinity = std::numeric_limits<T>::infinity();
  const int cells = axis.cells();
  for (int i = 0; i < cells; ++i) {
    const T lower = axis.plane(i), upper = axis.plane(i + 1);
    EXPECT_EQ(find_cell(axis, lower), i);
    EXPECT_EQ(find_cell(axis, lower + (upper - lower) / 2), i);
    EXPECT_EQ(find_cell(axis, std::nextafter(upper, -infinity)), i);
  }
  EXPECT_EQ(find_cell(axis, axis.plane(cells)), cells - 1);
  EXPECT_EQ(find_cell(axis, -infinity), 0);
  EXPECT_EQ(find_cell(axis, infinity), cells - 1);
  EXPECT_EQ(find_cell(axis, T(-1e30)), 0);
  EXPECT_EQ(find_cell(axis, T(1e30)), cells - 1);
  EXPECT_EQ(find_cell(axis, std::numeric_limits<T>::quiet_NaN()), 0);
}

TEST(FindCell, EveryKindOfAxis) {
  const double planes[] = {-3, -2.5, 0, 0.125, 7};
  expect_cells_found(GridAxis<double>{nullptr, 6, 0});
  expect_cells_found(GridAxis<double>{nullptr, 2, 0});
  expect_cells_found(GridAxis<double>{nullptr, 6, 1});
  expect_cells_found(GridAxis<double>{nullptr, 1, 1});
  expect_cells_found(GridAxis<double>{planes, 5, 0});
  expect_cells_found(GridAxis<double>{planes, 3, 1});
  expect_cells_found(GridAxis<float>{nullptr, 6, 1});
}

TEST(StructuredGrid, CornersAreXFastest) {
  std::vector<std::int16_t> data(2 * 3 * 4);
  for (std::size_t i = 0; i < data.size(); ++i) data[i] = static_cast<std::int16_t>(i);
  const StructuredGrid<std::int16_t, double> grid{
      data.data(), {{nullptr, 2, 0}, {nullptr, 3, 0}, {nullptr, 4, 0}}};
  const CellCorners<float> c = grid.corners<float>(0, 1, 2);
  const auto at = [](int i, int j, int k) { return static_cast<float>(i + 2 * (j + 3 * k)); };
  const float expected[] = {at(0, 1, 2), at(1, 1, 2), at(0, 2, 2), at(1, 2, 2),
                            at(0, 1, 3), at(1, 1, 3), at(0, 2, 3), at(1, 2, 3)};
  for (int n = 0; n < 8; ++n) EXPECT_EQ(c.value[n], expected[n]);
}

TEST(StructuredGrid, OuterHalfCellsRepeatTheBorder) {
  const std::vector<float> data{1, 2};
  const StructuredGrid<float, double> grid{data.data(),
                                           {{nullptr, 2, 1}, {nullptr, 1, 1}, {nullptr, 1, 1}}};
  const float expected[3][2] = {{1, 1}, {1, 2}, {2, 2}};
  for (int i = 0; i < 3; ++i) {
    const CellCorners<double> c = grid.corners<double>(i, 1, 0);
    for (int n = 0; n < 8; ++n) {
      EXPECT_EQ(c.value[n], static_cast<double>(expected[i][n & 1]));
    }
  }
}

TEST(StructuredGrid, OffsetsBeyond32Bits) {
  const StructuredGrid<float, double> grid{
      nullptr, {{nullptr, 3000, 0}, {nullptr, 3000, 0}, {nullptr, 3000, 0}}};
  EXPECT_EQ(grid.offset(2999, 2999, 2999), 26999999999);
}

}  // namespace
}  // namespace pellucid::test_structured_grid
