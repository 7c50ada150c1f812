// SPDX-License-Identifier: Apache-2.0
#include "cell_cut.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include "grid_check.h"
#include "quadratic_cells.h"

namespace pellucid {
namespace {

/// Where a part of the cells begins in the grid's lists and in the cut's.
struct Part {
  std::size_t cell = 0, corner = 0, lacking = 0, tetrahedron = 0;
};

/// Parts of a thousand cells, and behind them where the last one ends.
std::vector<Part> make_parts(const UnstructuredGrid& grid) {
  constexpr std::size_t cells = 1024;
  std::vector<Part> parts;
  parts.reserve(grid.shapes.size() / cells + 2);
  Part at;
  for (const CellShape shape : grid.shapes) {
    if (at.cell % cells == 0) parts.push_back(at);
    ++at.cell;
    at.corner += static_cast<std::size_t>(point_count(shape));
    at.lacking += lacking_nodes(shape).size();
  }
  parts.push_back(at);
  return parts;
}

/// Calls body(part) for all parts but the end.
template <class Body>
void each_part(const std::vector<Part>& parts, const ParallelFor& parallel, const Body& body) {
  parallel_or_serial(parallel)(static_cast<int>(parts.size()) - 1, [&](int first, int last) {
    for (int p = first; p < last; ++p) body(static_cast<std::size_t>(p));
  });
}

/// Calls emit(a, b, c, d) for the tetrahedra of a cell; `lacking` are the nodes that it lacks.
template <class Emit>
void cut_cell(CellShape shape, const std::int32_t* v, const std::int32_t* lacking,
              const Vec3<double>* points, const Emit& emit) {
  std::array<std::int32_t, 27> nodes;
  const auto completed = [&] {
    const std::int32_t* const end = v + point_count(shape);
    std::copy_n(lacking, lacking_nodes(shape).size(), std::copy(v, end, nodes.begin()));
    return nodes.data();
  };
  switch (shape) {
    case CellShape::tetrahedron:
      return emit(v[0], v[1], v[2], v[3]);
    case CellShape::pyramid:
      return cut_pyramid(v, emit);
    case CellShape::wedge:
      return cut_wedge(v, emit);
    case CellShape::hexahedron:
      return cut_hexahedron(v, emit);
    case CellShape::voxel:
      return cut_voxel(v, emit);
    case CellShape::quadratic_tetrahedron:
      return cut_quadratic_tetrahedron(v, points, emit);
    case CellShape::quadratic_pyramid:
      return cut_quadratic_pyramid(completed(), emit);
    case CellShape::quadratic_wedge:
      return cut_quadratic_wedge(completed(), emit);
    case CellShape::quadratic_hexahedron:
      return cut_quadratic_hexahedron(completed(), emit);
    case CellShape::biquadratic_wedge:
      return cut_quadratic_wedge(v, emit);
    case CellShape::triquadratic_hexahedron:
      return cut_quadratic_hexahedron(v, emit);
  }
}

/// Calls emit(cell, a, b, c, d) for the tetrahedra of a part that have four points.
template <class Emit>
void cut_part(const UnstructuredGrid& grid, const CellCut& cut, const Part& begin, const Part& end,
              const Emit& emit) {
  const std::int32_t* v = grid.corners.data() + begin.corner;
  const std::int32_t* lacking = cut.middle.indices.data() + begin.lacking;
  for (std::size_t cell = begin.cell; cell < end.cell; ++cell) {
    const CellShape shape = grid.shapes[cell];
    cut_cell(shape, v, lacking, cut.points.data(),
             [&](std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
               if (a != b && a != c && a != d && b != c && b != d && c != d) {
                 emit(cell, a, b, c, d);
               }
             });
    v += point_count(shape);
    lacking += lacking_nodes(shape).size();
  }
}

/// Counts the tetrahedra before each part.
void count_tetrahedra(const UnstructuredGrid& grid, const CellCut& cut, std::vector<Part>& parts,
                      const ParallelFor& parallel) {
  each_part(parts, parallel, [&](std::size_t p) {
    std::size_t count = 0;
    cut_part(grid, cut, parts[p], parts[p + 1],
             [&](std::size_t, std::int32_t, std::int32_t, std::int32_t, std::int32_t) { ++count; });
    parts[p].tetrahedron = count;
  });
  std::size_t before = 0;
  for (Part& part : parts) before += std::exchange(part.tetrahedron, before);
}

std::vector<Vec3<double>> all_points(const UnstructuredGrid& grid, const MiddlePoints& middle) {
  std::vector<Vec3<double>> points;
  points.reserve(grid.points.size() + middle.points.size());
  points = grid.points;
  for (const MiddlePoint& point : middle.points) {
    Vec3<double> at;
    for (int axis = 0; axis < 3; ++axis) {
      at[axis] = point.interpolated(
          [&](std::int32_t node) { return grid.points[static_cast<std::size_t>(node)][axis]; });
    }
    points.push_back(at);
  }
  return points;
}

}  // namespace

CellCut cut_cells(const UnstructuredGrid& grid, bool with_cells, const ParallelFor& parallel) {
  check_cells(grid);
  CellCut cut;
  cut.middle = find_middle_points(grid);
  cut.points = all_points(grid, cut.middle);
  std::vector<Part> parts = make_parts(grid);
  count_tetrahedra(grid, cut, parts, parallel);

  constexpr std::size_t most = std::size_t{1} << 28;  // as TetrahedralMesh
  const std::size_t count = parts.back().tetrahedron;
  if (count > most) {
    fail(grid, "its cells are " + std::to_string(count) + " tetrahedra, but at most " +
                   std::to_string(most) + " can be; take a part of it");
  }
  cut.tetrahedra.resize(count);
  if (with_cells) cut.cell.resize(count);
  each_part(parts, parallel, [&](std::size_t p) {
    std::size_t next = parts[p].tetrahedron;
    cut_part(grid, cut, parts[p], parts[p + 1],
             [&](std::size_t cell, std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
               cut.tetrahedra[next] = {a, b, c, d};
               if (with_cells) cut.cell[next] = static_cast<std::int32_t>(cell);
               ++next;
             });
  });
  return cut;
}

}  // namespace pellucid
