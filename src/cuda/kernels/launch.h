// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cuda_runtime.h>

#include "pellucid/cuda/device_scene.h"

namespace pellucid {

// Start the kernels of a look on a stream, which go on when these return. A source each, for they
// take long to compile. The scene and the task's arrays are in the card's memory, its counts 0.

void launch_grid(const DeviceScene& scene, const DeviceTask& task, cudaStream_t stream);
void launch_lit_grid(const DeviceScene& scene, const DeviceTask& task, cudaStream_t stream);
void launch_channels(const DeviceScene& scene, const DeviceTask& task, cudaStream_t stream);
void launch_mesh(const DeviceScene& scene, const DeviceTask& task, cudaStream_t stream);
void launch_mesh_channels(const DeviceScene& scene, const DeviceTask& task, cudaStream_t stream);

}  // namespace pellucid
