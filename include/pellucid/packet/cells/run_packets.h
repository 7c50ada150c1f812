// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/blocks/packet_grid.h"

namespace pellucid {

/// Has packets follow the rays of a job, one after the other.
template <class Packet>
void run_packets(const PellucidPacketJob& job) noexcept {
  const PacketGrid grid(job);
  typename Packet::Workspace workspace;
  for (int first = 0; first < job.count; first += Packet::lane_count) {
    const int left = job.count - first;
    Packet packet(job, grid, workspace, first,
                  left < Packet::lane_count ? left : Packet::lane_count);
    packet.run();
    packet.store(job.results);
  }
}

}  // namespace pellucid
