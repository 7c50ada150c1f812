// SPDX-License-Identifier: Apache-2.0
#include "grid_check.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "pellucid/scene/error.h"
#include "polyhedra.h"

namespace pellucid {
namespace {

std::string named(const UnstructuredGrid& grid, std::size_t cell) {
  return "cell " + std::to_string(cell_number(grid, cell));
}

/// Returns "cell 7", the one that a corner belongs to.
std::string cell_of_corner(const UnstructuredGrid& grid, std::size_t corner) {
  CellWalk walk(grid);
  std::size_t cell = 0;
  while (true) {
    walk.next();
    if (walk.done() || walk.places()[1] > corner) return named(grid, cell);
    ++cell;
  }
}

/// Throws Error unless the layouts are as many numbers as the shapes want, and sensible ones.
/// Returns how many corners they want.
std::size_t check_layouts(const UnstructuredGrid& grid) {
  std::size_t at = 0, corners = 0;
  const std::vector<std::int32_t>& layouts = grid.layouts;
  for (std::size_t cell = 0; cell < grid.shapes.size(); ++cell) {
    const CellShape shape = grid.shapes[cell];
    if (const int count = point_count(shape); count > 0) {
      corners += static_cast<std::size_t>(count);
      continue;
    }
    const bool is_polyhedron = shape == CellShape::polyhedron;
    const std::size_t left = layouts.size() - at;
    const auto refuse = [&](const std::string& what) {
      fail(grid, named(grid, cell) + ": " + what);
    };
    constexpr std::size_t of_lagrange = 4;
    if (left < (is_polyhedron ? 2 : of_lagrange)) refuse("its layout is missing");
    const std::int32_t* const layout = layouts.data() + at;
    if (layout[0] < 1) refuse("its layout has " + std::to_string(layout[0]) + " points");
    if (is_polyhedron) {
      if (layout[1] < 0 || static_cast<std::size_t>(layout[1]) > left - 2) {
        refuse("its layout of " + std::to_string(layout[1]) + " faces is cut off");
      }
      std::int64_t sum = 0;
      for (std::int32_t f = 0; f < layout[1]; ++f) {
        if (layout[2 + f] < 0) refuse("a face has a negative number of points");
        sum += layout[2 + f];
      }
      if (sum != layout[0]) {
        refuse("its faces have " + std::to_string(sum) + " points, but it says " +
               std::to_string(layout[0]));
      }
      at += 2 + static_cast<std::size_t>(layout[1]);
    } else {
      const std::array<int, 3> orders{layout[1], layout[2], layout[3]};
      const bool of_order_2 = orders == std::array{2, 2, 2};
      const bool with_middles =
          of_order_2 && ((shape == CellShape::lagrange_tetrahedron && layout[0] == 15) ||
                         (shape == CellShape::lagrange_wedge && layout[0] == 21));
      if (!with_middles && layout[0] != lagrange_points(shape, orders)) {
        refuse("a Lagrange cell of the orders " + std::to_string(orders[0]) + ", " +
               std::to_string(orders[1]) + ", " + std::to_string(orders[2]) + " does not have " +
               std::to_string(layout[0]) + " points");
      }
      at += of_lagrange;
    }
    corners += static_cast<std::size_t>(layout[0]);
  }
  if (at != layouts.size()) fail(grid, "it has more layouts than its cells need");
  return corners;
}

/// Throws Error where the faces of a polyhedron are not those of a body.
void check_polyhedra(const UnstructuredGrid& grid) {
  if (grid.layouts.empty()) return;
  std::size_t number = 0;
  for (CellWalk walk(grid); !walk.done(); ++number) {
    const GridCell cell = walk.next();
    if (cell.shape != CellShape::polyhedron) continue;
    if (const std::string fault = polyhedron_fault(cell.points, cell.layout); !fault.empty()) {
      fail(grid, named(grid, number) + ": " + fault + "; correct the cell");
    }
  }
}

}  // namespace

std::int32_t cell_number(const UnstructuredGrid& grid, std::size_t cell) {
  return grid.cell_numbers.empty() ? static_cast<std::int32_t>(cell) : grid.cell_numbers[cell];
}

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
  if (!grid.cell_numbers.empty() && grid.cell_numbers.size() != grid.shapes.size()) {
    fail(grid, "there are " + std::to_string(grid.cell_numbers.size()) + " numbers for " +
                   std::to_string(grid.shapes.size()) + " cells; give one for each, or none");
  }
  const std::size_t corners = check_layouts(grid);
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
  if (largest < points) return check_polyhedra(grid);
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
