// SPDX-License-Identifier: Apache-2.0
//
// Compiled once per instruction set, with namespace pellucid under a name of its own
// (cmake/PellucidInstructionSets.cmake).
#include "pellucid/packet/mesh/multivariate_mesh_packet.h"

PELLUCID_DEFINE_KERNEL(pellucid_integrate_multivariate_mesh) {
  constexpr int lanes = PELLUCID_LANES;
  using Packet = pellucid::MultivariateMeshPacket<lanes>;
  typename Packet::Workspace workspace;
  for (int first = 0; first < job->count; first += lanes) {
    Packet packet(*job, workspace, first, pellucid::min(lanes, job->count - first));
    packet.run();
    packet.store(job->results);
  }
}
