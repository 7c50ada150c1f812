// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/scene/block_classes_storage.h"

namespace pellucid {

/// Makes those blocks smooth or wavy (BlockKind, SmoothBlocks) that are: of the candidates, whose transfer
/// function is steady, those that are so together with the others of their group of 4³ blocks.
///
/// roughness: of each block SmoothBlocks::roughness, negative where it is no candidate.
SmoothBlocks find_smooth_blocks(const BlockRecords& records, const std::vector<float>& roughness,
                                double most_bending, const ParallelFor& parallel,
                                BlockClass* classes);

}  // namespace pellucid
