// SPDX-License-Identifier: Apache-2.0
#include <cuda_runtime.h>

#include <algorithm>
#include <string>

#include "kernels/launch.h"
#include "pellucid/cuda/device_backend.h"
#include "pellucid/scene/error.h"

namespace pellucid {
namespace {

/// Throws Error if a call failed. The runtime is linked into the program and looks for the driver
/// when it is first called: without one, that call fails.
void check(cudaError_t status, const char* what) {
  if (status == cudaSuccess) return;
  throw Error("device cuda: " + std::string(what) + ": " + cudaGetErrorString(status));
}

/// Throws Error unless there is a card that can be used.
void check_card() {
  int cards = 0;
  const cudaError_t status = cudaGetDeviceCount(&cards);
  if (status == cudaErrorInsufficientDriver) {
    throw Error("device cuda: there is no driver of NVIDIA, or it is older than CUDA " +
                std::to_string(CUDART_VERSION / 1000) + "." +
                std::to_string(CUDART_VERSION % 1000 / 10) + "; install one, or use --device cpu");
  }
  if (status == cudaErrorNoDevice || (status == cudaSuccess && cards == 0)) {
    throw Error("device cuda: there is no card of NVIDIA; use --device cpu");
  }
  check(status, "the driver");
}

class CudaBackend : public DeviceBackend {
 public:
  CudaBackend() {
    check_card();
    check(cudaSetDevice(0), "card 0");
    cudaDeviceProp card{};
    check(cudaGetDeviceProperties(&card, 0), "card 0");
    name_ = card.name;
    check(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "a stream");
  }
  ~CudaBackend() override { cudaStreamDestroy(stream_); }

  std::string name() const override { return name_; }

  void* allocate(std::size_t bytes) override {
    use_card();
    void* memory = nullptr;
    const cudaError_t status = cudaMalloc(&memory, std::max<std::size_t>(bytes, 1));
    if (status == cudaErrorMemoryAllocation) {
      cudaGetLastError();  // it is told of here, and not by the next call again
      throw Error("device cuda: the card has no room for " + std::to_string(bytes) +
                  " bytes more; use --device cpu");
    }
    check(status, "memory");
    return memory;
  }
  void release(void* memory) noexcept override {
    cudaSetDevice(0);
    cudaFree(memory);
  }
  void upload(void* to, const void* from, std::size_t bytes) override {
    copy(to, from, bytes, cudaMemcpyHostToDevice);
  }
  void download(void* to, const void* from, std::size_t bytes) override {
    copy(to, from, bytes, cudaMemcpyDeviceToHost);
  }
  void clear(void* memory, std::size_t bytes) override {
    use_card();
    check(cudaMemsetAsync(memory, 0, bytes, stream_), "memory");
  }

  void trace(const DeviceScene& scene, const DeviceTask& task,
             const ParallelFor& /*parallel*/) override {
    clear(task.counts, sizeof(DeviceCounts));
    launch(scene, task);
    check(cudaGetLastError(), "a kernel");
    check(cudaStreamSynchronize(stream_), "a kernel");
  }

 private:
  /// Chooses the card, which CUDA does per thread; frames come from any thread.
  static void use_card() { check(cudaSetDevice(0), "card 0"); }

  void copy(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind) {
    use_card();
    check(cudaMemcpyAsync(to, from, bytes, kind, stream_), "a copy");
    check(cudaStreamSynchronize(stream_), "a copy");
  }
  void launch(const DeviceScene& scene, const DeviceTask& task) const {
    switch (scene.look) {
      case DeviceLook::grid:
        return launch_grid(scene, task, stream_);
      case DeviceLook::lit_grid:
        return launch_lit_grid(scene, task, stream_);
      case DeviceLook::channels:
        return launch_channels(scene, task, stream_);
      case DeviceLook::mesh:
        return launch_mesh(scene, task, stream_);
      case DeviceLook::mesh_channels:
        break;
    }
    launch_mesh_channels(scene, task, stream_);
  }

  std::string name_;
  cudaStream_t stream_ = nullptr;
};

}  // namespace

std::unique_ptr<DeviceBackend> make_cuda_backend() {
  return std::make_unique<CudaBackend>();
}

}  // namespace pellucid
