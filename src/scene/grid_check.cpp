// SPDX-License-Identifier: Apache-2.0
#include "grid_check.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "pellucid/scene/error.h"

namespace pellucid {
namespace {

/// "cell 7", the one that a corner belongs to.
std::string cell_of_corner(const UnstructuredGrid& grid, std::size_t corner) {
  std::size_t cell = 0, end = 0;
  for (; cell < grid.shapes.size(); ++cell) {
    end += static_cast<std::size_t>(point_count(grid.shapes[cell]));
    if (end > corner) break;
  }
  return "cell " + std::to_string(cell);
}

}  // namespace

void fail(const UnstructuredGrid& grid, const std::string& message) {
  throw Error((grid.name.empty() ? "grid" : grid.name) + ": " + message);
}

void check_cells(const UnstructuredGrid& grid) {
  constexpr auto most = static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
  if (grid.shapes.empty()) fail(grid, "there is no cell; give at least one with a volume");
  if (grid.shapes.size() > most || grid.points.size() > most) {
    fail(grid, "there are " + std::to_string(grid.shapes.size()) + " cells and " +
                   std::to_string(grid.points.size()) + " points, but at most " +
                   std::to_string(most) + " of each can be; take a part of it");
  }
  std::size_t corners = 0;
  for (const CellShape shape : grid.shapes) corners += static_cast<std::size_t>(point_count(shape));
  if (grid.corners.size() != corners) {
    fail(grid, "the shapes of its cells need " + std::to_string(corners) + " corners, but " +
                   std::to_string(grid.corners.size()) + " are there");
  }
  // A negative index is a large one.
  const auto points = static_cast<std::uint32_t>(grid.points.size());
  std::uint32_t largest = 0;
  for (const std::int32_t point : grid.corners) {
    largest = std::max(largest, static_cast<std::uint32_t>(point));
  }
  if (largest < points) return;
  const auto bad = std::ranges::find_if(grid.corners, [&](std::int32_t point) {
    return static_cast<std::uint32_t>(point) >= points;
  });
  fail(grid, cell_of_corner(grid, static_cast<std::size_t>(bad - grid.corners.begin())) +
                 " has point " + std::to_string(*bad) + ", but points are numbered from 0 to " +
                 std::to_string(static_cast<std::int64_t>(points) - 1) + "; correct the index");
}

void check_array(const UnstructuredGrid& grid, const MeshArray& array) {
  const bool point = array.centering == Centering::point;
  const std::size_t size =
      std::visit([](const auto& values) { return values.size(); }, array.values);
  const std::size_t places = point ? grid.points.size() : grid.shapes.size();
  if (array.components >= 1 && size == places * static_cast<std::size_t>(array.components)) return;
  fail(grid, "array \"" + array.name + "\" has " + std::to_string(size) + " values, but " +
                 std::to_string(places) + (point ? " points" : " cells") + " of " +
                 std::to_string(array.components) + " component" +
                 (array.components == 1 ? "" : "s") + " are to have one each");
}

}  // namespace pellucid
