// SPDX-License-Identifier: Apache-2.0
//
// Compiled once per instruction set, with namespace pellucid under a name of its own
// (cmake/PellucidInstructionSets.cmake).
#include "pellucid/packet/cells/packet_integrator.h"
#include "pellucid/simd/flush_to_zero.h"
#include "pellucid/simd/instruction_set.h"

namespace {

template <class Value>
void run(const PellucidPacketJob& job) {
  constexpr int lanes = PELLUCID_LANES;
  using Integrator = pellucid::PacketIntegrator<Value, lanes, true>;
  const pellucid::PacketGrid<Value> grid(job);
  typename Integrator::Room room;
  for (int first = 0; first < job.count; first += lanes) {
    Integrator packet(job, grid, room, first, pellucid::min(lanes, job.count - first));
    packet.run();
    packet.store(job.results);
  }
}

}  // namespace

extern "C" void PELLUCID_ENTRY(pellucid_integrate_lit_packets)(const PellucidPacketJob* job) {
  const pellucid::FlushToZero mode;
  pellucid::with_value_type(job->type, [job](auto value) {
    using Value = decltype(value);
    if constexpr (std::is_same_v<Value, float> || sizeof(Value) <= 2) run<Value>(*job);
  });
}
