// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ghost_cells.h"

namespace pellucid::vtk_scene {

/// Flags of vtkGhostType of points or of cells; none: there is no such array.
using GhostFlags = std::optional<std::span<const unsigned char>>;

/// Returns which values of an image or a rectilinear grid are hidden (vtkGhostType: HIDDENPOINT,
/// HIDDENCELL, REFINEDCELL); empty if none is. A cell is hidden with one of its points, and a value
/// at a point with all of its cells. `sides`: how many cells there are along each axis. Throws
/// Error, which `name` begins, if a cell is hidden between cells that are not, so that none of its
/// points is hidden: values at points cannot show that.
std::vector<bool> hidden_places(const GhostFlags& points, const GhostFlags& cells,
                                const std::array<int, 3>& sides, bool of_cells,
                                const std::string& name);

/// Flags of cells of a mesh that are not shown.
inline constexpr int unseen_cell = duplicate_cell | refined_cell | hidden_cell;
/// Returns whether one of a cell's corners is hidden, which hides the cell. Corners that are not
/// there are passed over.
inline bool has_hidden_corner(std::span<const unsigned char> points,
                              std::span<const std::int64_t> corners) {
  return std::ranges::any_of(corners, [&](std::int64_t point) {
    return point >= 0 && point < static_cast<std::int64_t>(points.size()) &&
           (points[static_cast<std::size_t>(point)] & hidden_point) != 0;
  });
}

}  // namespace pellucid::vtk_scene
