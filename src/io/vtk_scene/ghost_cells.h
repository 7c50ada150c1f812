// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pellucid/geometry/affine.h"
#include "pellucid/scene/clip.h"

namespace pellucid::vtk_scene {

/// Bits of vtkGhostType.
inline constexpr int duplicate_cell = 1, hidden_point = 2, refined_cell = 8, hidden_cell = 32;

/// The cells of a grid that are no ghosts.
struct OwnCells {
  std::array<int, 3> first{}, last{};  ///< ends of the box around them, in cells
  std::int64_t count = 0;
};
/// Returns them by the flags of all cells; `sides`: how many cells there are along each axis.
OwnCells own_cells(std::span<const unsigned char> flags, const std::array<int, 3>& sides);

/// An image or a rectilinear grid with ghost cells (vtkGhostType: DUPLICATECELL): they are another
/// block's or another process's, there for values and gradients at the border.
struct GhostCells {
  OwnCells own;
  std::array<int, 3> sides{};  ///< cells of the grid along each axis
  /// Returns a point of the grid, in the world of its data.
  std::function<Vec3<double>(const std::array<int, 3>& index)> point;
};

/// Returns the planes around the grid's own cells, in the world; nothing if all are ghosts. A face
/// between cells belongs to those above it: planes lie 2^-20 of a cell below it, so that a surface
/// in the face is shown once. Throws Error if the cells that are no ghosts do not fill a box;
/// `name` begins the message.
std::optional<std::vector<Clip>> clips_at_ghosts(const GhostCells& ghosts,
                                                 const Affine<double>& world_from_data,
                                                 const std::string& name);

}  // namespace pellucid::vtk_scene
