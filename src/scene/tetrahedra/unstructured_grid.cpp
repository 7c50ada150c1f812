// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/unstructured_grid.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "pellucid/scene/error.h"

namespace pellucid {

int point_count(CellShape shape) noexcept {
  constexpr std::array<std::int8_t, 15> points{4, 5, 6, 8, 8, 10, 13, 15, 20, 18, 27, 0, 0, 0, 0};
  return points[static_cast<std::size_t>(shape)];
}

int lagrange_points(CellShape shape, const std::array<int, 3>& orders) noexcept {
  // Below it no product of three is beyond 64 bits.
  constexpr int largest_order = 2000;
  if (std::ranges::any_of(orders, [](int k) { return k < 1 || k > largest_order; })) return 0;
  const std::int64_t a = orders[0], b = orders[1], c = orders[2];
  std::int64_t count = 0;
  if (shape == CellShape::lagrange_tetrahedron) count = (a + 1) * (a + 2) * (a + 3) / 6;
  if (shape == CellShape::lagrange_wedge) count = (a + 1) * (a + 2) / 2 * (c + 1);
  if (shape == CellShape::lagrange_hexahedron) count = (a + 1) * (b + 1) * (c + 1);
  return count > std::numeric_limits<int>::max() ? 0 : static_cast<int>(count);
}

GridCell CellWalk::next() noexcept {
  GridCell cell{grid_->shapes[cell_++], {}, {}};
  auto count = static_cast<std::size_t>(point_count(cell.shape));
  if (count == 0) {
    const std::int32_t* const layout = grid_->layouts.data() + layout_;
    count = static_cast<std::size_t>(layout[0]);
    constexpr std::size_t of_lagrange = 4;
    const std::size_t length =
        cell.shape == CellShape::polyhedron ? 2 + static_cast<std::size_t>(layout[1]) : of_lagrange;
    cell.layout = {layout, length};
    layout_ += length;
  }
  cell.points = {grid_->corners.data() + point_, count};
  point_ += count;
  return cell;
}

std::vector<std::int32_t> grid_hexahedra(const std::array<int, 3>& points) {
  constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
  std::int64_t count = 1;
  bool counted = true;
  for (const int n : points) {
    if (n < 2) {
      throw Error("grid: " + std::to_string(points[0]) + " x " + std::to_string(points[1]) + " x " +
                  std::to_string(points[2]) +
                  " points span no cells; give at least two along each axis");
    }
    counted = counted && count <= most / n;
    count = counted ? count * n : count;
  }
  if (!counted) {
    throw Error("grid: " + std::to_string(points[0]) + " x " + std::to_string(points[1]) + " x " +
                std::to_string(points[2]) + " points are more than " + std::to_string(most) +
                ", which a mesh can have; take a part of it");
  }

  const int nx = points[0], layer = points[0] * points[1];
  const auto cells = [&](std::size_t axis) { return static_cast<std::size_t>(points[axis] - 1); };
  std::vector<std::int32_t> corners(8 * cells(0) * cells(1) * cells(2));
  auto next = corners.begin();
  for (int k = 0; k + 1 < points[2]; ++k) {
    for (int j = 0; j + 1 < points[1]; ++j) {
      for (int i = 0; i + 1 < points[0]; ++i) {
        const std::int32_t first = i + nx * j + layer * k;
        for (const std::int32_t below : {first, first + layer}) {
          for (const std::int32_t corner : {below, below + 1, below + 1 + nx, below + nx}) {
            *next++ = corner;
          }
        }
      }
    }
  }
  return corners;
}

}  // namespace pellucid
