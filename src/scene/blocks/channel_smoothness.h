// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/scene/channels.h"
#include "pellucid/scene/multivariate_transfer_function.h"
#include "pellucid/traverse/multivariate_blocks.h"

namespace pellucid {

/// Makes those blocks smooth (BlockKind, SmoothChannels) that are, of those not to be skipped:
/// where all channels are so that a primitive looks at, over the group of 4³ blocks that it is in.
/// `waves` is made what SmoothChannels::waves is to refer to. Returns SmoothChannels::longest_step.
/// `negligible`: the extinction below which primitives do not matter.
double find_smooth_channels(const Channels& channels,
                            const MultivariateTransferFunction& transfer_function,
                            const PrimitiveSet* primitives, double negligible,
                            const ParallelFor& parallel, BlockClass* classes,
                            std::vector<float>& waves);

}  // namespace pellucid
