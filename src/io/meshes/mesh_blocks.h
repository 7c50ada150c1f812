// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "pellucid/io/read_mesh.h"

namespace pellucid {

/// A mesh as a format's reader leaves it: each block a grid of its own, whose points' indices are
/// checked; all else in the file's place.
struct MeshBlocks {
  MeshFile file;
  std::vector<UnstructuredGrid> blocks;
  std::size_t cells = 0;            ///< of all blocks so far, those that are left out too
  bool is_active_of_cells = false;  ///< whether MeshFile::active is the name of an array of cells
};

/// Joins the blocks to the file's one grid, and makes points of different blocks one where they
/// stand at the same place with the same values. Arrays of the same name are one: of the blocks'
/// type where they agree, else double; NaN where a block lacks it. One of cells that is named like
/// one of points gets "_cell" behind its name, and the active one is known by that. Throws Error
/// where the numbers of components differ, or there is no cell.
MeshFile join_blocks(MeshBlocks&& mesh, const std::string& name);

/// Puts "_cell" behind the name of each array of cells that is named like one of points.
void name_cells_apart(std::vector<MeshArray>& arrays);

/// Returns a message about cells that list more points than their shape has: how many of `cells`,
/// and the first of them. Returns an empty text if there are none.
std::string trimmed_note(const MeshFile& file, std::size_t cells);

/// Returns the index of the step nearest to `wanted`, of two as near the one of the earlier time;
/// the first where nothing is wanted. `times` is not empty.
inline std::size_t nearest_step(const std::vector<double>& times,
                                std::optional<double> wanted) noexcept {
  if (!wanted) return 0;
  const double moment = *wanted;
  const auto nearest = std::min_element(times.begin(), times.end(), [&](double a, double b) {
    // A time that is missing is none.
    if (std::isnan(a) || std::isnan(b)) return std::isnan(b) && !std::isnan(a);
    const double from_a = std::abs(a - moment), from_b = std::abs(b - moment);
    if (from_a != from_b) return from_a < from_b;
    // Far away distances are rounded to the same.
    return a <= moment && b <= moment ? a > b : a < b;
  });
  return static_cast<std::size_t>(nearest - times.begin());
}

}  // namespace pellucid
