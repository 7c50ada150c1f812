// SPDX-License-Identifier: Apache-2.0
#include "kernels/kernels.h"

namespace pellucid {

void launch_channels(const DeviceScene& scene, const DeviceTask& task, cudaStream_t stream) {
  kernels::launch_lattice<DeviceLook::channels, false>(scene, task, stream);
}

}  // namespace pellucid
