// SPDX-License-Identifier: Apache-2.0
//
// Compiled once per instruction set, with namespace pellucid under a name of its own
// (cmake/PellucidInstructionSets.cmake).
#include "pellucid/packet/bundle/multivariate_cell_packet.h"
#include "pellucid/simd/flush_to_zero.h"

PELLUCID_DEFINE_KERNEL(pellucid_integrate_multivariate_cells) {
  const pellucid::FlushToZero mode;
  constexpr int lanes = PELLUCID_LANES;
  using Packet = pellucid::MultivariateCellPacket<lanes>;
  const PellucidPacketJob& rays = job->grid_and_rays;
  const pellucid::PacketGrid grid(rays);
  typename Packet::Workspace workspace;
  for (int first = 0; first < rays.count; first += lanes) {
    Packet packet(*job, grid, workspace, first, pellucid::min(lanes, rays.count - first));
    packet.run();
    packet.store(rays.results);
  }
}
