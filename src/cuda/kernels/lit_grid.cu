// SPDX-License-Identifier: Apache-2.0
#include "kernels/kernels.h"

namespace pellucid {

void launch_lit_grid(const DeviceScene& scene, const DeviceTask& task, cudaStream_t stream) {
  kernels::launch_lattice<DeviceLook::lit_grid, false>(scene, task, stream);
}

}  // namespace pellucid
