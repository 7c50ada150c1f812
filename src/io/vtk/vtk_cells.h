// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "meshes/mesh_blocks.h"

namespace pellucid {

/// End of a message on parts of a file that contradict each other.
inline constexpr const char* damaged_file = "; the file is cut off or damaged";

/// A cell as VTK's files have it; nothing of it is checked.
struct VtkCell {
  int type = 0;  ///< VTK's number
  std::span<const std::int64_t> points;
  /// Faces of polyhedra: the number of faces, and of each face the number of its points and these.
  std::span<const std::int64_t> faces{};
  /// Orders of Lagrange cells, if the file says them; else their points are as many along each
  /// axis.
  std::optional<std::array<int, 3>> orders{};
};

/// Puts VTK's cells into a grid, and counts what is left out.
class VtkCells {
 public:
  /// `first_number` is the number of the block's first cell. The block's points are there.
  VtkCells(std::size_t first_number, MeshFile& file, UnstructuredGrid& block) noexcept
      : first_number_(first_number), file_(file), block_(block) {}

  /// Returns whether it is kept: cells of surfaces, lines and points are not. Of more points than
  /// its shape has the first are taken. Throws Error, naming the cell, which is called by its
  /// number in the block, for types that have a volume but are not read, too few points, points
  /// that are not there, and faces that do not agree with themselves.
  bool add(std::int64_t cell, const VtkCell& given);
  /// Counts a cell that is a ghost or hidden.
  void add_ghost() noexcept { ++file_.ghost_cells; }

 private:
  void add_points(std::span<const std::int64_t> points);
  void add_shape(CellShape shape, std::span<const std::int64_t> points);
  void add_lagrange(CellShape shape, const VtkCell& given);
  void add_prism(std::span<const std::int64_t> points, std::size_t sides);
  void add_polyhedron(const VtkCell& given);

  std::size_t first_number_;
  MeshFile& file_;
  UnstructuredGrid& block_;
  std::int64_t cell_ = 0;  ///< the one that is added
};

}  // namespace pellucid
