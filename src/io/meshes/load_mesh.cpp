// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

#include "files/memory_limit.h"
#include "load_mesh_step.h"
#include "pellucid/io/channel_source.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/tetrahedralize_step.h"

namespace pellucid {

namespace {

/// Returns about how many tetrahedra a cell becomes.
std::uintmax_t pieces_of(const GridCell& cell) {
  // Below 2001 each: lagrange_points().
  const auto order = [&](std::size_t axis) {
    return static_cast<std::uintmax_t>(cell.layout[axis + 1]);
  };
  switch (cell.shape) {
    case CellShape::tetrahedron:
      return 1;
    case CellShape::pyramid:
      return 2;
    case CellShape::wedge:
      return 3;
    case CellShape::hexahedron:
    case CellShape::voxel:
      return 6;
    case CellShape::quadratic_tetrahedron:
      return 8;
    case CellShape::quadratic_pyramid:
      return 20;
    case CellShape::quadratic_wedge:
    case CellShape::biquadratic_wedge:
      return 24;
    case CellShape::quadratic_hexahedron:
    case CellShape::triquadratic_hexahedron:
      return 48;
    case CellShape::lagrange_tetrahedron:
      return cell.points.size() + order(0) * order(0) * order(0);
    case CellShape::lagrange_wedge:
      return cell.points.size() + 3 * order(0) * order(0) * order(2);
    case CellShape::lagrange_hexahedron:
      return 6 * order(0) * order(1) * order(2);
    case CellShape::polyhedron:
      break;
  }
  return cell.points.size();  // two less than its points of each face
}

void check_mesh_memory(const UnstructuredGrid& grid) {
  std::uintmax_t tetrahedra = 0;
  for (CellWalk walk(grid); !walk.done();) tetrahedra += pieces_of(walk.next());
  // Corners and neighbors, and while neighbors are looked for the faces too.
  constexpr std::uintmax_t bytes = 128;
  check_memory(tetrahedra * bytes,
               grid.name + ": its " + std::to_string(tetrahedra) + " tetrahedra");
}

}  // namespace

void prefer_whole_names(const std::vector<MeshArray>& arrays,
                        std::vector<MeshArrayChoice>& choices) {
  for (MeshArrayChoice& choice : choices) {
    if (!choice.component) continue;
    const std::string whole = choice.array + ":" + std::to_string(*choice.component);
    const auto is_whole = [&](const MeshArray& array) { return array.name == whole; };
    if (std::ranges::none_of(arrays, is_whole)) continue;
    choice.array = whole;
    choice.component.reset();
  }
}

std::string overlap_note(const MeshStatistics& s) {
  if (s.folded_faces == 0) return "";
  // Crushed cells are few; an exporter writes all of a kind in its own order.
  const bool most = 2 * s.overlapping_cells >= s.cells;
  return std::to_string(s.overlapping_cells) + " of " + std::to_string(s.cells) +
         " cells overlap themselves or a neighbour (the first is cell " +
         std::to_string(s.first_overlapping_cell) + ", counted from 0), at " +
         std::to_string(s.folded_faces) +
         " faces of their tetrahedra: pixels that see it are not known; the likely cause is " +
         (most ? "the order of the cells' nodes, which is not that of the format"
               : "the order of their nodes, or that they are crushed or turned inside out");
}

LoadedMesh load_mesh(const MeshSource& source, const ParallelFor& parallel) {
  return load_mesh_step(source, nullptr, parallel);
}

LoadedMesh load_mesh_step(const MeshSource& source, const MeshChannels* before,
                          const ParallelFor& parallel) {
  MeshFile file = read_mesh(source.file, source.options);
  LoadedMesh loaded{nullptr, source.channels};
  if (loaded.channels.empty()) {
    loaded.channels = {{default_array(file).name, std::nullopt, std::string(field_channel)}};
  }
  std::vector<MeshArray>& arrays = file.grid.arrays;
  prefer_whole_names(arrays, loaded.channels);
  const auto is_chosen = [&](const MeshArray& array) {
    return std::ranges::any_of(loaded.channels,
                               [&](const auto& choice) { return choice.array == array.name; });
  };
  const bool all_there = std::ranges::all_of(loaded.channels, [&](const auto& choice) {
    return std::ranges::any_of(arrays,
                               [&](const auto& array) { return choice.array == array.name; });
  });
  // Where one is missing the message names those that are there.
  if (all_there) std::erase_if(arrays, [&](const MeshArray& array) { return !is_chosen(array); });
  check_mesh_memory(file.grid);
  loaded.mesh = file.times.size() > 1
                    ? tetrahedralize_step(std::move(file.grid), loaded.channels, before, parallel)
                    : cut_into_tetrahedra(file.grid, loaded.channels, parallel);
  const std::string overlap = overlap_note(loaded.mesh->mesh().statistics());
  if (source.options.note && !overlap.empty()) source.options.note(overlap);
  return loaded;
}

}  // namespace pellucid
