// SPDX-License-Identifier: Apache-2.0
//
// Compiled once per instruction set, with namespace pellucid under a name of its own
// (cmake/PellucidInstructionSets.cmake).
#include "pellucid/packet/sample/multivariate_sampler.h"

PELLUCID_DEFINE_KERNEL(pellucid_sample_multivariate) {
  constexpr int lanes = PELLUCID_LANES;
  const PellucidPacketJob& rays = job->grid_and_rays;
  const pellucid::PacketGrid grid(rays);
  for (int first = 0; first < rays.count; first += lanes) {
    pellucid::MultivariateSampler<lanes> packet(*job, grid, first,
                                                pellucid::min(lanes, rays.count - first));
    packet.run();
    packet.store(rays.results);
  }
}
