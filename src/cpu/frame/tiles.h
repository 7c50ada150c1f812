// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "pellucid/cpu/render.h"

namespace pellucid {

/// Pixels along an edge of a tile; fewer where the image ends. A multiple of 4, so that packets of
/// rays fit.
inline constexpr int tile_edge = 16;

/// Returns all tiles of a frame, each pixel in exactly one: the levels from coarse to fine, each
/// from the middle of the image outwards, where what takes long tends to come first and neighbours
/// share data.
std::vector<Tile> make_tiles(ImageSize size, int preview);

/// Returns the tiles of the pixels whose columns and rows are multiples of `stride`.
std::vector<Tile> make_lattice(ImageSize size, int stride);

inline std::size_t pixel_count(const Tile& tile) {
  return static_cast<std::size_t>(tile.columns) * static_cast<std::size_t>(tile.rows);
}

}  // namespace pellucid
