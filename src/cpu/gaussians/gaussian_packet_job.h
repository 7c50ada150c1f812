// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/field/multichannel_grid.h"
#include "pellucid/packet/gaussian_packet_interface.h"
#include "pellucid/scene/channels.h"
#include "pellucid/traverse/multivariate_blocks.h"

namespace pellucid {

using GaussianPacketKernel = void (*)(const PellucidGaussianPacketJob*);

/// Returns whether packets can go through all of the channels (packet_setup.h).
bool suits_packets(const Channels& channels, double largest_extinction);

/// Fills the job that both multivariate kernels share; refers to all arguments. `largest_color` of
/// the transfer function. Tolerance and mixture are left to the caller.
PellucidGaussianPacketJob gaussian_packet_job(const Channels& channels,
                                              const MultivariateBlocks& blocks,
                                              const MultichannelGrid& grid,
                                              double largest_extinction, double largest_color);

void trace(GaussianPacketKernel kernel, PellucidGaussianPacketJob job,
           const std::vector<PellucidRay>& rays, bool depth, PellucidRayResult* results);

}  // namespace pellucid
