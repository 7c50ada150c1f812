// SPDX-License-Identifier: Apache-2.0
#include "kernels/kernels.h"

namespace pellucid {

void launch_grid(const DeviceScene& scene, const DeviceTask& task, cudaStream_t stream) {
  if (!scene.single_first) {
    kernels::launch_lattice<DeviceLook::grid, false>(scene, task, stream);
    return;
  }
  kernels::launch_lattice<DeviceLook::grid, true>(scene, task, stream);
  kernels::launch_queue<DeviceLook::grid>(scene, task, stream);
}

}  // namespace pellucid
