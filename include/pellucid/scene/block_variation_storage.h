// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/scene/channels.h"
#include "pellucid/traverse/block_variation.h"

namespace pellucid {

/// Makes and owns how much the data of channels vary around each block: once a frame, from the
/// blocks' records alone. 16 bytes a block of 8³ cells and channel, and as
/// many while they are made.
class BlockVariationStorage {
 public:
  BlockVariationStorage() = default;
  /// In parallel where it is told how.
  explicit BlockVariationStorage(const Channels& channels, const ParallelFor& parallel = {});

  /// Of block b and channel c at b · channels + c; blocks x fastest.
  const BlockVariation* data() const noexcept { return variation_.data(); }

 private:
  std::vector<BlockVariation> variation_;
};

}  // namespace pellucid
