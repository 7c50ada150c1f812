// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "pellucid/scene/volume.h"
#include "pellucid/traverse/block_classes.h"

namespace pellucid {

/// Writes BlockClass::level of those blocks of this kind, of so many along each axis, whose kinds
/// are known: from blocks up to the cubes that hold nothing else, and down again.
void find_block_levels(const std::array<int, 3>& blocks, BlockKind kind,
                       const ParallelFor& parallel, BlockClass* classes);

}  // namespace pellucid
