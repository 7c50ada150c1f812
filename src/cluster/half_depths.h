// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/cluster/communicator.h"
#include "pellucid/cpu/render.h"
#include "pellucid/scene/scene.h"

namespace pellucid {

/// Finds where half of the opacity of each ray is reached, in two rounds: each rank learns what is
/// in front of its brick and what the whole ray has; the one in whose brick the half lies follows
/// the ray again. Returns world arc lengths on all ranks, infinite for rays without opacity.
/// `composite`: of all bricks, on rank 0. `own`: of this brick, which comes at that place.
std::vector<float> half_depths(Communicator& ranks, int place, const Scene& rays,
                               const RenderOptions& options, const std::vector<RayPixel>& composite,
                               const std::vector<RayPixel>& own);

}  // namespace pellucid
