// SPDX-License-Identifier: Apache-2.0
#include "gaussian_packet_job.h"

#include <algorithm>

#include "packet_setup.h"

namespace pellucid {

bool suits_packets(const Channels& channels, double largest_extinction) {
  return std::all_of(channels.begin(), channels.end(), [&](const Channel& channel) {
    return suits_packets(*channel.volume, largest_extinction);
  });
}

PellucidGaussianPacketJob gaussian_packet_job(const Channels& channels,
                                              const MultivariateBlocks& blocks,
                                              const MultichannelGrid& grid,
                                              double largest_extinction, double largest_color) {
  PellucidGaussianPacketJob job{};
  set_grid(channels.grid(), job.grid_and_rays);
  job.grid_and_rays.classes = blocks.classes.block;
  job.grid_and_rays.largest_extinction = largest_extinction;
  job.grid_and_rays.largest_color = std::max(largest_color, 1.0);
  job.left_out = blocks.left_out;
  job.grid = &grid;
  job.primitives = blocks.primitives;
  return job;
}

void trace(GaussianPacketKernel kernel, PellucidGaussianPacketJob job,
           const std::vector<PellucidRay>& rays, bool depth, PellucidRayResult* results) {
  job.grid_and_rays.rays = rays.data();
  job.grid_and_rays.count = static_cast<std::int32_t>(rays.size());
  job.grid_and_rays.results = results;
  job.grid_and_rays.depth = depth ? 1 : 0;
  kernel(&job);
}

}  // namespace pellucid
