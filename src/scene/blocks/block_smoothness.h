// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

#include "pellucid/scene/internal/block_classes_storage.h"

namespace pellucid {

/// Facts of the transfer function over the range of a block, if it may be sampled.
struct SampledBlock {
  float roughness = -1;  ///< SmoothBlocks::roughness; negative: it may not
  float steps = std::numeric_limits<float>::infinity();  ///< BlockRoughness::Range
};

/// Makes those blocks smooth (BlockKind, SmoothBlocks) that are: of those that may be sampled,
/// those that are so together with the others of their group of 4³ blocks. `local` is made what
/// SmoothBlocks::local is to refer to; empty if no block is smooth. Lets go of `sampled`.
SmoothBlocks find_smooth_blocks(const BlockRecords& records, std::vector<SampledBlock> sampled,
                                const StepLimits& limits, const ParallelFor& parallel,
                                BlockClass* classes, std::vector<float>& local);

}  // namespace pellucid
