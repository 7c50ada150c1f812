// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/scene/channels.h"
#include "pellucid/traverse/block_variation.h"

namespace pellucid {

/// Builds and owns the variation of each channel around each block. It is built once per frame from
/// the block records alone. It takes 16 bytes per channel and block of 8³ cells, and as much again
/// while it is built.
class BlockVariationStorage {
 public:
  BlockVariationStorage() = default;
  /// Measures all blocks, in parallel if `parallel` is given.
  explicit BlockVariationStorage(const Channels& channels, const ParallelFor& parallel = {});

  /// Returns the variations: block b and channel c are at index b · channels + c, blocks x fastest.
  const BlockVariation* data() const noexcept { return variation_.data(); }

 private:
  std::vector<BlockVariation> variation_;
};

}  // namespace pellucid
