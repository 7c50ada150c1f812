// SPDX-License-Identifier: Apache-2.0
//
// Compiled once per instruction set, with namespace pellucid under a name of its own
// (cmake/PellucidInstructionSets.cmake).
#include "pellucid/packet/mesh/mesh_packet.h"
#include "pellucid/simd/flush_to_zero.h"

namespace {

template <class S>
void run(const PellucidMeshJob& job) {
  constexpr int lanes = PELLUCID_LANES;
  using Packet = pellucid::MeshPacket<S, lanes>;
  typename Packet::Workspace workspace[2];
  for (int first = 0; first < job.count;) {
    const auto next = [&](typename Packet::Workspace& of_packet) {
      const int begin = first;
      first = pellucid::min(begin + lanes, job.count);
      return Packet(job, of_packet, begin, first - begin);
    };
    Packet one = next(workspace[0]);
    if (first == job.count) {
      Packet::run({&one});
    } else {
      Packet other = next(workspace[1]);
      Packet::run({&one, &other});
      other.store(job.results);
    }
    one.store(job.results);
  }
}

}  // namespace

PELLUCID_DEFINE_KERNEL(pellucid_integrate_mesh) {
  const pellucid::FlushToZero mode;
  job->in_double != 0 ? run<double>(*job) : run<float>(*job);
}
