// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "pellucid/scene/volume.h"

namespace pellucid {

/// Returns the mean edges of the cells between a volume's values, in the world.
inline std::array<double, 3> voxel_edges(const Volume& volume) noexcept {
  const std::array<Vec3<double>, 8> corners = volume.world_corners();
  std::array<double, 3> edges{};
  for (std::size_t a = 0; a < 3; ++a) {
    const int values = volume.description().dimensions[a];
    const int cells = volume.description().centering == Centering::cell ? values : values - 1;
    edges[a] = length(corners[std::size_t{1} << a] - corners[0]) / std::max(cells, 1);
  }
  return edges;
}

}  // namespace pellucid
