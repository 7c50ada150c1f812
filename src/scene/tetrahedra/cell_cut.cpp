// SPDX-License-Identifier: Apache-2.0
#include "cell_cut.h"

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

/// Beginning of a part of the cells in the grid's lists (CellWalk::places) and in the cut's.
struct Part {
  std::array<std::size_t, 3> places{};
  std::size_t lacking = 0, tetrahedron = 0;
};

/// Parts of a thousand cells, and behind them where the last one ends.
std::vector<Part> make_parts(const UnstructuredGrid& grid) {
  constexpr std::size_t cells = 1024;
  std::vector<Part> parts;
  parts.reserve(grid.shapes.size() / cells + 2);
  std::size_t lacking = 0;
  CellWalk walk(grid);
  while (!walk.done()) {
    const std::array<std::size_t, 3> places = walk.places();
    if (places[0] % cells == 0) parts.push_back({places, lacking, 0});
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
class Cutter {
 public:
  Cutter(const CellCut& cut, const LagrangeTables& tables)
      : points_(cut.points.data()), tables_(tables), polygons_(points_) {}

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
        return cut_pyramid(v, emit);
      case CellShape::wedge:
        return cut_wedge(v, emit);
      case CellShape::hexahedron:
        return cut_hexahedron(v, emit);
      case CellShape::voxel:
        return cut_voxel(v, emit);
      case CellShape::quadratic_tetrahedron:
        return cut_quadratic_tetrahedron(v, points_, emit);
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
      case CellShape::lagrange_tetrahedron: {
        const LagrangeNodes& nodes = tables_.of(cell);
        return nodes.has_middles() ? cut_tetrahedron_of_15(v, emit)
                                   : cut_lagrange_tetrahedron(nodes, v, points_, emit);
      }
      case CellShape::lagrange_wedge: {
        const LagrangeNodes& nodes = tables_.of(cell);
        return nodes.has_middles() ? cut_wedge_of_21(v, emit) : cut_lagrange_wedge(nodes, v, emit);
      }
      case CellShape::lagrange_hexahedron:
        return cut_lagrange_hexahedron(tables_.of(cell), v, emit);
      case CellShape::polyhedron:
        return cut_polyhedron(cell, *lacking, polygons_, emit);
    }
  }

 private:
  const Vec3<double>* points_;
  const LagrangeTables& tables_;
  PolygonCut polygons_;
  std::array<std::int32_t, 27> nodes_{};
};

/// Calls emit(cell, a, b, c, d) for the tetrahedra of a part that have four points.
template <class Emit>
void cut_part(const UnstructuredGrid& grid, const CellCut& cut, const LagrangeTables& tables,
              const Part& begin, const Part& end, const Emit& emit) {
  Cutter cutter(cut, tables);
  CellWalk walk(grid, begin.places);
  const std::int32_t* lacking = cut.middle.indices.data() + begin.lacking;
  for (std::size_t number = begin.places[0]; number < end.places[0]; ++number) {
    const GridCell cell = walk.next();
    cutter(cell, lacking, [&](std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
      if (a != b && a != c && a != d && b != c && b != d && c != d) emit(number, a, b, c, d);
    });
    lacking += lacking_count(cell.shape);
  }
}

/// Counts the tetrahedra before each part.
void count_tetrahedra(const UnstructuredGrid& grid, const CellCut& cut,
                      const LagrangeTables& tables, std::vector<Part>& parts,
                      const ParallelFor& parallel) {
  each_part(parts, parallel, [&](std::size_t p) {
    std::size_t count = 0;
    cut_part(grid, cut, tables, parts[p], parts[p + 1],
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
  for (const MiddlePoint& point : middle.points) points.push_back(place_of(grid, point));
  return points;
}

}  // namespace

CellCut cut_cells(const UnstructuredGrid& grid, bool with_cells, const ParallelFor& parallel) {
  check_cells(grid);
  CellCut cut;
  cut.middle = find_middle_points(grid);
  cut.points = all_points(grid, cut.middle);
  const LagrangeTables tables(grid);
  std::vector<Part> parts = make_parts(grid);
  count_tetrahedra(grid, cut, tables, parts, parallel);

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
    cut_part(grid, cut, tables, parts[p], parts[p + 1],
             [&](std::size_t cell, std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
               cut.tetrahedra[next] = {a, b, c, d};
               if (with_cells) cut.cell[next] = static_cast<std::int32_t>(cell);
               ++next;
             });
  });
  return cut;
}

}  // namespace pellucid
