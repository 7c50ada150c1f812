// SPDX-License-Identifier: Apache-2.0
#include "middle_points.h"

#include <algorithm>
#include <limits>
#include <unordered_map>

#include "grid_check.h"

namespace pellucid {
namespace {

constexpr MiddleNode pyramid_middles[]{{4, {0, 1, 2, 3, 5, 6, 7, 8}}};

constexpr MiddleNode wedge_middles[]{{4, {0, 1, 4, 3, 6, 13, 9, 12}},
                                     {4, {1, 2, 5, 4, 7, 14, 10, 13}},
                                     {4, {2, 0, 3, 5, 8, 12, 11, 14}}};

constexpr MiddleNode hexahedron_middles[]{
    {4, {0, 3, 7, 4, 11, 19, 15, 16}},
    {4, {1, 2, 6, 5, 9, 18, 13, 17}},
    {4, {0, 1, 5, 4, 8, 17, 12, 16}},
    {4, {3, 2, 6, 7, 10, 18, 14, 19}},
    {4, {0, 1, 2, 3, 8, 9, 10, 11}},
    {4, {4, 5, 6, 7, 12, 13, 14, 15}},
    {8, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19}}};

/// The nodes in the middle that a cell of this shape has, at the end of its points.
std::span<const MiddleNode> given_nodes(CellShape shape) noexcept {
  if (shape == CellShape::biquadratic_wedge) return wedge_middles;
  if (shape == CellShape::triquadratic_hexahedron) return hexahedron_middles;
  return {};
}

/// The corners of a quadrilateral, in ascending order.
using Quadrilateral = std::array<std::int32_t, 4>;

struct QuadrilateralHash {
  std::size_t operator()(const Quadrilateral& q) const noexcept {
    std::uint64_t hash = 0;
    for (const std::int32_t point : q) {
      hash = (hash ^ static_cast<std::uint32_t>(point)) * 0x9e3779b97f4a7c15U;
      hash ^= hash >> 32;
    }
    return hash;
  }
};

using Middles = std::unordered_map<Quadrilateral, std::int32_t, QuadrilateralHash>;

Quadrilateral quadrilateral(const MiddleNode& node, const std::int32_t* cell) {
  Quadrilateral corners;
  for (std::size_t i = 0; i < 4; ++i) corners[i] = cell[node.nodes[i]];
  std::ranges::sort(corners);
  return corners;
}

/// Calls body(shape, the cell's points).
template <class Body>
void each_cell(const UnstructuredGrid& grid, const Body& body) {
  const std::int32_t* cell = grid.corners.data();
  for (const CellShape shape : grid.shapes) {
    body(shape, cell);
    cell += point_count(shape);
  }
}

/// The middles of quadrilaterals that cells bring along: their neighbours may lack them.
Middles given_middles(const UnstructuredGrid& grid) {
  Middles middles;
  each_cell(grid, [&](CellShape shape, const std::int32_t* cell) {
    const std::span<const MiddleNode> given = given_nodes(shape);
    const std::int32_t* const own = cell + point_count(shape) - given.size();
    for (std::size_t i = 0; i < given.size(); ++i) {
      if (given[i].corners == 4) middles.try_emplace(quadrilateral(given[i], cell), own[i]);
    }
  });
  return middles;
}

}  // namespace

std::span<const MiddleNode> lacking_nodes(CellShape shape) noexcept {
  if (shape == CellShape::quadratic_pyramid) return pyramid_middles;
  if (shape == CellShape::quadratic_wedge) return wedge_middles;
  if (shape == CellShape::quadratic_hexahedron) return hexahedron_middles;
  return {};
}

MiddlePoints find_middle_points(const UnstructuredGrid& grid) {
  MiddlePoints found;
  std::size_t lacking = 0;
  for (const CellShape shape : grid.shapes) lacking += lacking_nodes(shape).size();
  if (lacking == 0) return found;
  if (lacking >
      static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()) - grid.points.size()) {
    fail(grid, "its quadratic cells need more points than can be counted; take a part of it");
  }

  Middles middles = given_middles(grid);
  found.indices.reserve(lacking);
  found.points.reserve(lacking / 2);
  each_cell(grid, [&](CellShape shape, const std::int32_t* cell) {
    for (const MiddleNode& node : lacking_nodes(shape)) {
      auto index = static_cast<std::int32_t>(grid.points.size() + found.points.size());
      bool is_new = true;
      if (node.corners == 4) {
        const auto [at, inserted] = middles.try_emplace(quadrilateral(node, cell), index);
        index = at->second;
        is_new = inserted;
      }
      if (is_new) found.points.push_back({&node, cell});
      found.indices.push_back(index);
    }
  });
  return found;
}

}  // namespace pellucid
