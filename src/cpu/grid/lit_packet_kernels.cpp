// SPDX-License-Identifier: Apache-2.0
//
// Compiled once per instruction set, with namespace pellucid under a name of its own
// (cmake/PellucidInstructionSets.cmake).
#include "pellucid/packet/cells/packet_integrator.h"
#include "pellucid/packet/cells/run_packets.h"
#include "pellucid/simd/flush_to_zero.h"

PELLUCID_DEFINE_KERNEL(pellucid_integrate_lit_packets) {
  const pellucid::FlushToZero mode;
  pellucid::run_packets<pellucid::PacketIntegrator<PELLUCID_LANES, true>>(*job);
}
