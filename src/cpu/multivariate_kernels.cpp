// SPDX-License-Identifier: Apache-2.0
//
// Compiled once per instruction set, with namespace pellucid under a name of its own
// (cmake/PellucidInstructionSets.cmake).
#include "pellucid/packet/multivariate_ray.h"
#include "pellucid/simd/instruction_set.h"

extern "C" void PELLUCID_ENTRY(pellucid_integrate_multivariate)(
    const PellucidMultivariateJob* job) {
  using Ray = pellucid::MultivariateRay<PELLUCID_LANES>;
  typename Ray::Room room;
  for (int i = 0; i < job->count; ++i) {
    Ray ray(*job, job->rays[i], room);
    ray.run();
    ray.store(job->results[i]);
  }
}
