// SPDX-License-Identifier: Apache-2.0
//
// Compiled once per instruction set, with namespace pellucid under a name of its own
// (cmake/PellucidInstructionSets.cmake).
#include "pellucid/packet/steps/gaussian_packet.h"
#include "pellucid/simd/instruction_set.h"

extern "C" void PELLUCID_ENTRY(pellucid_integrate_gaussian_packets)(
    const PellucidGaussianPacketJob* job) {
  const pellucid::PacketGrid grid(job->grid_and_rays);
  pellucid::GaussianPacket<PELLUCID_LANES> packet(*job, grid);
  packet.run();
}
