// SPDX-License-Identifier: Apache-2.0
#include "tetrahedralized_cells.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include "grid_check.h"
#include "lagrange_cells.h"
#include "polyhedra.h"
#include "quadratic_cells.h"

namespace pellucid {
namespace {

/// Beginning of a part of the cells in the grid's lists (CellWalk::places) and in the tetrahedra's.
struct Part {
  std::array<std::size_t, 3> places{};
  std::size_t lacking = 0, tetrahedron = 0;
};

/// Returns parts of a thousand cells, and behind them where the last one ends.
std::vector<Part> make_parts(const UnstructuredGrid& grid) {
  constexpr std::size_t cells_of_a_part = 1024;
  std::vector<Part> parts;
  parts.reserve(grid.shapes.size() / cells_of_a_part + 2);
  std::size_t lacking = 0;
  CellWalk walk(grid);
  while (!walk.done()) {
    const std::array<std::size_t, 3> places = walk.places();
    if (places[0] % cells_of_a_part == 0) parts.push_back({places, lacking, 0});
    lacking += lacking_count(walk.next().shape);
  }
  parts.push_back({walk.places(), lacking, 0});
  return parts;
}

/// Calls body(part) for all parts but the end.
template <class Body>
void each_part(const std::vector<Part>& parts, const ParallelFor& parallel, const Body& body) {
  parallel_or_serial(parallel)(static_cast<int>(parts.size()) - 1, [&](int first, int last) {
    for (int p = first; p < last; ++p) body(static_cast<std::size_t>(p));
  });
}

/// Cuts the cells of a part, one after the other.
class Tetrahedralizer {
 public:
  Tetrahedralizer(const TetrahedralizedCells& cells, const LagrangeTables& tables)
      : points_(cells.points.data()), tables_(tables), polygons_(points_) {}

  /// Calls emit(a, b, c, d) for the tetrahedra of a cell; `lacking` are the points that it lacks.
  template <class Emit>
  void operator()(const GridCell& cell, const std::int32_t* lacking, const Emit& emit) {
    const std::int32_t* const v = cell.points.data();
    const auto completed = [&] {
      std::copy_n(lacking, lacking_count(cell.shape),
                  std::ranges::copy(cell.points, nodes_.begin()).out);
      return nodes_.data();
    };
    switch (cell.shape) {
      case CellShape::tetrahedron:
        return emit(v[0], v[1], v[2], v[3]);
      case CellShape::pyramid:
        return tetrahedralize_pyramid(v, emit);
      case CellShape::wedge:
        return tetrahedralize_wedge(v, emit);
      case CellShape::hexahedron:
        return tetrahedralize_hexahedron(v, emit);
      case CellShape::voxel:
        return tetrahedralize_voxel(v, emit);
      case CellShape::quadratic_tetrahedron:
        return tetrahedralize_quadratic_tetrahedron(v, points_, emit);
      case CellShape::quadratic_pyramid:
        return tetrahedralize_quadratic_pyramid(completed(), emit);
      case CellShape::quadratic_wedge:
        return tetrahedralize_quadratic_wedge(completed(), emit);
      case CellShape::quadratic_hexahedron:
        return tetrahedralize_quadratic_hexahedron(completed(), emit);
      case CellShape::biquadratic_wedge:
        return tetrahedralize_quadratic_wedge(v, emit);
      case CellShape::triquadratic_hexahedron:
        return tetrahedralize_quadratic_hexahedron(v, emit);
      case CellShape::lagrange_tetrahedron: {
        const LagrangeNodes& nodes = tables_.of(cell);
        return nodes.has_middles() ? tetrahedralize_tetrahedron_of_15(v, emit)
                                   : tetrahedralize_lagrange_tetrahedron(nodes, v, points_, emit);
      }
      case CellShape::lagrange_wedge: {
        const LagrangeNodes& nodes = tables_.of(cell);
        return nodes.has_middles() ? tetrahedralize_wedge_of_21(v, emit)
                                   : tetrahedralize_lagrange_wedge(nodes, v, emit);
      }
      case CellShape::lagrange_hexahedron:
        return tetrahedralize_lagrange_hexahedron(tables_.of(cell), v, emit);
      case CellShape::polyhedron:
        return tetrahedralize_polyhedron(cell, *lacking, polygons_, emit);
    }
  }

 private:
  const Vec3<double>* points_;
  const LagrangeTables& tables_;
  PolygonTriangulation polygons_;
  std::array<std::int32_t, 27> nodes_{};
};

/// Calls emit(cell, a, b, c, d) for the tetrahedra of a part that have four points.
template <class Emit>
void tetrahedralize_part(const UnstructuredGrid& grid, const TetrahedralizedCells& cells,
                         const LagrangeTables& tables, const Part& begin, const Part& end,
                         const Emit& emit) {
  Tetrahedralizer tetrahedralizer(cells, tables);
  CellWalk walk(grid, begin.places);
  const std::int32_t* lacking = cells.added.indices.data() + begin.lacking;
  for (std::size_t number = begin.places[0]; number < end.places[0]; ++number) {
    const GridCell cell = walk.next();
    tetrahedralizer(cell, lacking,
                    [&](std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
                      if (a != b && a != c && a != d && b != c && b != d && c != d)
                        emit(number, a, b, c, d);
                    });
    lacking += lacking_count(cell.shape);
  }
}

/// Counts the tetrahedra before each part.
void count_tetrahedra(const UnstructuredGrid& grid, const TetrahedralizedCells& cells,
                      const LagrangeTables& tables, std::vector<Part>& parts,
                      const ParallelFor& parallel) {
  each_part(parts, parallel, [&](std::size_t p) {
    std::size_t count = 0;
    tetrahedralize_part(
        grid, cells, tables, parts[p], parts[p + 1],
        [&](std::size_t, std::int32_t, std::int32_t, std::int32_t, std::int32_t) { ++count; });
    parts[p].tetrahedron = count;
  });
  std::size_t before = 0;
  for (Part& part : parts) before += std::exchange(part.tetrahedron, before);
}

std::vector<Vec3<double>> all_points(const UnstructuredGrid& grid, const AddedPoints& added) {
  std::vector<Vec3<double>> points;
  points.reserve(grid.points.size() + added.points.size());
  points = grid.points;
  for (const AddedPoint& point : added.points) points.push_back(place_of(grid, point));
  return points;
}

}  // namespace

TetrahedralizedCells tetrahedralize_cells(const UnstructuredGrid& grid, bool with_cells,
                                          const ParallelFor& parallel) {
  check_cells(grid);
  TetrahedralizedCells cells;
  cells.added = find_added_points(grid);
  cells.points = all_points(grid, cells.added);
  const LagrangeTables tables(grid);
  std::vector<Part> parts = make_parts(grid);
  count_tetrahedra(grid, cells, tables, parts, parallel);

  constexpr std::size_t most = std::size_t{1} << 28;  // as TetrahedralMesh
  const std::size_t count = parts.back().tetrahedron;
  if (count > most) {
    fail(grid, "its cells are " + std::to_string(count) + " tetrahedra, but at most " +
                   std::to_string(most) + " can be; take a part of it");
  }
  cells.tetrahedra.resize(count);
  if (with_cells) cells.cell.resize(count);
  each_part(parts, parallel, [&](std::size_t p) {
    std::size_t next = parts[p].tetrahedron;
    tetrahedralize_part(
        grid, cells, tables, parts[p], parts[p + 1],
        [&](std::size_t cell, std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
          cells.tetrahedra[next] = {a, b, c, d};
          if (with_cells) cells.cell[next] = static_cast<std::int32_t>(cell);
          ++next;
        });
  });
  return cells;
}

}  // namespace pellucid
