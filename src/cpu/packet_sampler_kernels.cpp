// SPDX-License-Identifier: Apache-2.0
//
// Compiled once per instruction set, with namespace pellucid under a name of its own
// (cmake/PellucidInstructionSets.cmake).
#include "pellucid/packet/packet_sampler.h"
#include "pellucid/simd/instruction_set.h"

namespace {

template <class Value>
void run(const PellucidSamplerJob& job) {
  constexpr int lanes = PELLUCID_LANES;
  const PellucidPacketJob& rays = job.grid_and_rays;
  const pellucid::PacketGrid<Value> grid(rays);
  for (int first = 0; first < rays.count; first += lanes) {
    pellucid::PacketSampler<Value, lanes> packet(job, grid, first,
                                                 pellucid::min(lanes, rays.count - first));
    if (job.rule == pellucid_preintegrated) {
      packet.run_preintegrated();
    } else {
      packet.run_midpoint();
    }
    packet.store(rays.results);
  }
}

}  // namespace

extern "C" void PELLUCID_ENTRY(pellucid_sample_packets)(const PellucidSamplerJob* job) {
  switch (job->grid_and_rays.type) {
    case pellucid_u8:
      return run<std::uint8_t>(*job);
    case pellucid_i8:
      return run<std::int8_t>(*job);
    case pellucid_u16:
      return run<std::uint16_t>(*job);
    case pellucid_i16:
      return run<std::int16_t>(*job);
    case pellucid_u32:
      return run<std::uint32_t>(*job);
    case pellucid_i32:
      return run<std::int32_t>(*job);
    case pellucid_f32:
      return run<float>(*job);
    case pellucid_f64:
      return run<double>(*job);
  }
}
