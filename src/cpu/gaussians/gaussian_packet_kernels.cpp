// SPDX-License-Identifier: Apache-2.0
//
// Compiled once per instruction set, with namespace pellucid under a name of its own
// (cmake/PellucidInstructionSets.cmake).
#include "pellucid/packet/steps/gaussian_packet.h"

PELLUCID_DEFINE_KERNEL(pellucid_integrate_gaussian_packets) {
  const pellucid::PacketGrid grid(job->grid_and_rays);
  pellucid::GaussianPacket<PELLUCID_LANES> packet(*job, grid);
  packet.run();
}
