// SPDX-License-Identifier: Apache-2.0
//
// Compiled once per instruction set, with namespace pellucid under a name of its own
// (cmake/PellucidInstructionSets.cmake).
#include "pellucid/packet/sample/packet_sampler.h"
#include "pellucid/simd/flush_to_zero.h"

PELLUCID_DEFINE_KERNEL(pellucid_sample_packets) {
  const pellucid::FlushToZero mode;
  constexpr int lanes = PELLUCID_LANES;
  const PellucidPacketJob& rays = job->grid_and_rays;
  const pellucid::PacketGrid grid(rays);
  for (int first = 0; first < rays.count; first += lanes) {
    pellucid::PacketSampler<lanes> packet(*job, grid, first,
                                          pellucid::min(lanes, rays.count - first));
    if (job->rule == pellucid_preintegrated) {
      packet.run_preintegrated();
    } else {
      packet.run_midpoint();
    }
    packet.store(rays.results);
  }
}
