// SPDX-License-Identifier: Apache-2.0
#include "added_points.h"

#include <algorithm>
#include <limits>
#include <unordered_map>

#include "grid_check.h"
#include "polyhedra.h"

namespace pellucid {
namespace {

constexpr MidNode pyramid_middles[]{{4, {0, 1, 2, 3, 5, 6, 7, 8}}};

constexpr MidNode wedge_middles[]{{4, {0, 1, 4, 3, 6, 13, 9, 12}},
                                  {4, {1, 2, 5, 4, 7, 14, 10, 13}},
                                  {4, {2, 0, 3, 5, 8, 12, 11, 14}}};

constexpr MidNode hexahedron_middles[]{
    {4, {0, 3, 7, 4, 11, 19, 15, 16}},
    {4, {1, 2, 6, 5, 9, 18, 13, 17}},
    {4, {0, 1, 5, 4, 8, 17, 12, 16}},
    {4, {3, 2, 6, 7, 10, 18, 14, 19}},
    {4, {0, 1, 2, 3, 8, 9, 10, 11}},
    {4, {4, 5, 6, 7, 12, 13, 14, 15}},
    {8, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19}}};

/// Returns the nodes in the middle that a cell of this shape has, at the end of its points.
std::span<const MidNode> given_nodes(CellShape shape) noexcept {
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

Quadrilateral quadrilateral(const MidNode& node, const std::int32_t* cell) {
  Quadrilateral corners;
  for (std::size_t i = 0; i < 4; ++i) corners[i] = cell[node.nodes[i]];
  std::ranges::sort(corners);
  return corners;
}

/// Returns the middles of quadrilaterals that cells bring along: their neighbours may lack them.
Middles given_middles(const UnstructuredGrid& grid) {
  Middles middles;
  for (CellWalk walk(grid); !walk.done();) {
    const GridCell cell = walk.next();
    const std::span<const MidNode> given = given_nodes(cell.shape);
    const std::span<const std::int32_t> own = cell.points.last(given.size());
    for (std::size_t i = 0; i < given.size(); ++i) {
      if (given[i].corners != 4) continue;
      middles.try_emplace(quadrilateral(given[i], cell.points.data()), own[i]);
    }
  }
  return middles;
}

}  // namespace

std::span<const MidNode> lacking_nodes(CellShape shape) noexcept {
  if (shape == CellShape::quadratic_pyramid) return pyramid_middles;
  if (shape == CellShape::quadratic_wedge) return wedge_middles;
  if (shape == CellShape::quadratic_hexahedron) return hexahedron_middles;
  return {};
}

std::size_t lacking_count(CellShape shape) noexcept {
  return shape == CellShape::polyhedron ? 1 : lacking_nodes(shape).size();
}

Vec3<double> place_of(const UnstructuredGrid& grid, const AddedPoint& point) {
  Vec3<double> at;
  for (int axis = 0; axis < 3; ++axis) {
    at[axis] = point.interpolated(
        [&](std::int32_t node) { return grid.points[static_cast<std::size_t>(node)][axis]; });
  }
  return at;
}

AddedPoints find_added_points(const UnstructuredGrid& grid) {
  AddedPoints found;
  std::size_t lacking = 0;
  bool has_polyhedra = false;
  for (const CellShape shape : grid.shapes) {
    lacking += lacking_count(shape);
    has_polyhedra = has_polyhedra || shape == CellShape::polyhedron;
  }
  if (lacking == 0) return found;
  if (lacking >
      static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()) - grid.points.size()) {
    fail(grid,
         "its quadratic cells and polyhedra need more points than can be counted; take a part of "
         "it");
  }

  Middles middles = given_middles(grid);
  found.indices.reserve(lacking);
  found.points.reserve(lacking / 2);
  // Pointers into it stay where they are: it never grows beyond this.
  if (has_polyhedra) found.distinct.reserve(grid.corners.size());
  PolyhedronApex apex(grid.points.data());
  for (CellWalk walk(grid); !walk.done();) {
    const GridCell cell = walk.next();
    const std::int32_t* const own = cell.points.data();
    const auto next_index = [&] {
      return static_cast<std::int32_t>(grid.points.size() + found.points.size());
    };
    if (cell.shape == CellShape::polyhedron) {
      std::vector<std::int32_t>& all = found.distinct;
      const auto begin = static_cast<std::ptrdiff_t>(all.size());
      all.insert(all.end(), cell.points.begin(), cell.points.end());
      std::sort(all.begin() + begin, all.end());
      all.erase(std::unique(all.begin() + begin, all.end()), all.end());
      const AddedPoint mean{nullptr, all.data() + begin,
                            static_cast<std::int32_t>(std::ssize(all) - begin)};
      const std::span<const std::int32_t> distinct(mean.cell, static_cast<std::size_t>(mean.count));
      const std::int32_t own_point = apex(cell, distinct, place_of(grid, mean));
      found.indices.push_back(own_point < 0 ? next_index() : own_point);
      if (own_point < 0) found.points.push_back(mean);
      continue;
    }
    for (const MidNode& node : lacking_nodes(cell.shape)) {
      auto index = next_index();
      bool is_new = true;
      if (node.corners == 4) {
        const auto [at, inserted] = middles.try_emplace(quadrilateral(node, own), index);
        index = at->second;
        is_new = inserted;
      }
      if (is_new) found.points.push_back({&node, own, 0});
      found.indices.push_back(index);
    }
  }
  return found;
}

}  // namespace pellucid
