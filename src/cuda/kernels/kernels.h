// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cuda_runtime.h>

#include "kernels/launch.h"
#include "pellucid/cuda/trace_pixel.h"

/// Launches and indexing alone: what a thread does is trace_pixel() and count_pixel(), which the
/// tests run on the CPU.
namespace pellucid::kernels {

/// A block follows a patch of pixels, each of its warps 8 × 4: neighbors share cells.
inline constexpr unsigned patch_columns = 8, patch_rows = 16;
inline constexpr unsigned block_threads = patch_columns * patch_rows;
/// Blocks that go through a queue, whose length the host does not know.
inline constexpr unsigned queue_blocks = 1056;  // eight for each multiprocessor of an H100

/// Returns the number of patches along an axis of the lattice.
PELLUCID_HD constexpr std::int64_t patches_along(int pixels, unsigned patch) noexcept {
  return (std::int64_t{pixels} + patch - 1) / patch;
}

struct AtomicAdd {
  __device__ std::uint64_t operator()(std::uint64_t& target, std::uint64_t value) const noexcept {
    return atomicAdd(reinterpret_cast<unsigned long long*>(&target), value);
  }
};
struct AtomicMax {
  __device__ void operator()(std::uint64_t& target, std::uint64_t value) const noexcept {
    atomicMax(reinterpret_cast<unsigned long long*>(&target), value);
  }
};

/// The sums of a block, in its shared memory.
class BlockSums {
 public:
  /// Sets the sums to zero. All threads of the block call it.
  __device__ explicit BlockSums(std::uint64_t* shared) : shared_(shared) {
    for (unsigned i = threadIdx.x; i < numbers; i += block_threads) shared_[i] = 0;
    __syncthreads();
  }
  __device__ DeviceCounts& sums() const { return *reinterpret_cast<DeviceCounts*>(shared_); }
  /// Adds the sums of the block to the total. All its threads call it, when they are done.
  __device__ void add_to(DeviceCounts& total) const {
    __syncthreads();
    if (threadIdx.x == 0) add_sums(sums(), total, AtomicAdd{}, AtomicMax{});
  }

  static constexpr unsigned numbers = sizeof(DeviceCounts) / sizeof(std::uint64_t);

 private:
  std::uint64_t* shared_;
};

template <DeviceLook Look, bool SingleOnly>
__device__ void follow(const DeviceScene& scene, const DeviceTask& task, std::uint32_t pixel,
                       DeviceCounts& sums) {
  count_pixel(scene, trace_pixel<Look, SingleOnly>(scene, task.image, pixel), pixel, task, sums,
              AtomicAdd{}, AtomicMax{});
}

/// Follows the pixels of the lattice, or of the queue, whose length the host does not know. One
/// kernel for both, because each takes minutes to compile.
template <DeviceLook Look, bool SingleOnly>
__global__ void __launch_bounds__(block_threads)
    follow_pixels(const __grid_constant__ DeviceScene scene,
                  const __grid_constant__ DeviceTask task, bool from_queue) {
  __shared__ std::uint64_t shared[BlockSums::numbers];
  const BlockSums sums(shared);
  const std::int64_t patches = patches_along(task.pixels.columns, patch_columns),
                     all = patches * patches_along(task.pixels.rows, patch_rows) * block_threads;
  const std::int64_t count = from_queue ? static_cast<std::int64_t>(task.counts->in_double) : all;
  const std::int64_t step = std::int64_t{gridDim.x} * block_threads;
  for (std::int64_t i = std::int64_t{blockIdx.x} * block_threads + threadIdx.x; i < count;
       i += step) {
    std::uint32_t pixel;
    if (from_queue) {
      pixel = task.in_double.pixel[i];
    } else {
      const std::int64_t patch = i / block_threads;
      const std::int64_t column =
          patch % patches * patch_columns + i % block_threads % patch_columns;
      const std::int64_t row = patch / patches * patch_rows + i % block_threads / patch_columns;
      if (column >= task.pixels.columns || row >= task.pixels.rows) continue;
      pixel = pixel_number(task.pixels, row * task.pixels.columns + column, task.image.width);
    }
    follow<Look, SingleOnly>(scene, task, pixel, sums.sums());
  }
  sums.add_to(*task.counts);
}

/// Launches a thread for each pixel of the lattice.
template <DeviceLook Look, bool SingleOnly>
void launch_lattice(const DeviceScene& scene, const DeviceTask& task, cudaStream_t stream) {
  const std::int64_t blocks = patches_along(task.pixels.columns, patch_columns) *
                              patches_along(task.pixels.rows, patch_rows);
  follow_pixels<Look, SingleOnly>
      <<<static_cast<unsigned>(blocks), block_threads, 0, stream>>>(scene, task, false);
}

template <DeviceLook Look>
void launch_queue(const DeviceScene& scene, const DeviceTask& task, cudaStream_t stream) {
  follow_pixels<Look, false><<<queue_blocks, block_threads, 0, stream>>>(scene, task, true);
}

}  // namespace pellucid::kernels
