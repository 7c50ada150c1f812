// SPDX-License-Identifier: Apache-2.0
#include "pellucid/cuda/device_backend.h"
#include "pellucid/scene/error.h"

namespace pellucid {

std::unique_ptr<DeviceBackend> make_cuda_backend() {
  throw Error("device cuda: this program was built without it (-DPELLUCID_CUDA=ON)");
}

}  // namespace pellucid
