// SPDX-License-Identifier: Apache-2.0
//
// Compiled once per instruction set, with namespace pellucid under a name of its own
// (cmake/PellucidInstructionSets.cmake).
#include <new>

#include "pellucid/packet/layers/layered_packet.h"
#include "pellucid/simd/flush_to_zero.h"

PELLUCID_DEFINE_KERNEL(pellucid_integrate_layers) {
  using Packet = pellucid::LayeredPacket<PELLUCID_LANES>;
  static_assert(alignof(Packet) <= 64 && std::is_trivially_destructible_v<Packet>);
  const pellucid::FlushToZero mode;
  switch (job->step) {
    case PellucidLayeredJob::size:
      job->state_size = sizeof(Packet);
      job->lanes = PELLUCID_LANES;
      return;
    case PellucidLayeredJob::begin:
      new (job->state) Packet(*job);
      return;
    case PellucidLayeredJob::go_on:
      std::launder(reinterpret_cast<Packet*>(job->state))->run(*job);
      return;
    case PellucidLayeredJob::finish:
      std::launder(reinterpret_cast<const Packet*>(job->state))->store(*job);
      return;
  }
}
