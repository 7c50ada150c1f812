// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pellucid/scene/layer.h"

namespace pellucid {

/// The blocks of 8³ cells of a layer's grid, x fastest: 1 where a function of one variable absorbs
/// at some value that occurs, or an isosurface has such a value; else 0.
struct AbsorbingBlocks {
  std::array<int, 3> count{};
  std::vector<std::uint8_t> absorbs;
};
/// Finds them from the block records, which are made in parallel if `parallel` is given. The layer
/// has a grid.
AbsorbingBlocks absorbing_blocks(const Layer& layer, const ParallelFor& parallel = {});
/// Returns whether they tell where something is seen: of a grid with functions of one variable,
/// without projection and slices.
bool tells_by_blocks(const Layer& layer) noexcept;

}  // namespace pellucid
