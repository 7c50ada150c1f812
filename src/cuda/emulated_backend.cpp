// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <cstring>
#include <new>

#include "pellucid/cuda/device_backend.h"
#include "pellucid/cuda/trace_pixel.h"
#include "pellucid/scene/error.h"

namespace pellucid {
namespace {

constexpr std::align_val_t alignment{256};  // as cudaMalloc() gives

std::uint64_t add(std::uint64_t& target, std::uint64_t value) noexcept {
  return std::atomic_ref(target).fetch_add(value, std::memory_order_relaxed);
}

void raise(std::uint64_t& target, std::uint64_t value) noexcept {
  const std::atomic_ref atomic(target);
  std::uint64_t old = atomic.load(std::memory_order_relaxed);
  while (old < value && !atomic.compare_exchange_weak(old, value, std::memory_order_relaxed)) {
  }
}

/// Calls body(index, sums) for 0 <= index < count, as a card calls its threads: in no order, and in
/// blocks that have sums of their own.
template <class Body>
void launch(std::int64_t count, const DeviceTask& task, const ParallelFor& parallel,
            const Body& body) {
  constexpr std::int64_t block = 128;
  const auto blocks = static_cast<int>((count + block - 1) / block);
  parallel(blocks, [&](int first, int last) {
    for (int b = first; b < last; ++b) {
      DeviceCounts sums;
      for (std::int64_t i = b * block; i < std::min((b + 1) * block, count); ++i) body(i, sums);
      add_sums(sums, *task.counts, add, raise);
    }
  });
}

class EmulatedBackend : public DeviceBackend {
 public:
  std::string name() const override { return "the functions of a card, on the CPU"; }

  void* allocate(std::size_t bytes) override {
    void* const memory = ::operator new(std::max<std::size_t>(bytes, 1), alignment, std::nothrow);
    if (memory == nullptr) {
      throw Error("emulated device: no room for " + std::to_string(bytes) + " bytes");
    }
    return memory;
  }
  void release(void* memory) noexcept override { ::operator delete(memory, alignment); }
  void upload(void* to, const void* from, std::size_t bytes) override {
    std::memcpy(to, from, bytes);
  }
  void download(void* to, const void* from, std::size_t bytes) override {
    std::memcpy(to, from, bytes);
  }
  void clear(void* memory, std::size_t bytes) override { std::memset(memory, 0, bytes); }

  void trace(const DeviceScene& scene, const DeviceTask& task,
             const ParallelFor& parallel) override {
    *task.counts = {};
    with_look(scene.look, [&]<DeviceLook Look>() {
      if constexpr (Look == DeviceLook::grid) {
        if (scene.single_first) {
          follow_all<Look, true>(scene, task, parallel);
          follow_queue<Look>(scene, task, parallel);
          return;
        }
      }
      follow_all<Look, false>(scene, task, parallel);
    });
  }

 private:
  template <DeviceLook Look, bool SingleOnly>
  static void follow(const DeviceScene& scene, const DeviceTask& task, std::uint32_t pixel,
                     DeviceCounts& sums) {
    count_pixel(scene, trace_pixel<Look, SingleOnly>(scene, task.image, pixel), pixel, task, sums,
                add, raise);
  }
  template <DeviceLook Look, bool SingleOnly>
  static void follow_all(const DeviceScene& scene, const DeviceTask& task,
                         const ParallelFor& parallel) {
    launch(task.pixels.count(), task, parallel, [&](std::int64_t index, DeviceCounts& sums) {
      const std::uint32_t pixel = pixel_number(task.pixels, index, task.image.width);
      follow<Look, SingleOnly>(scene, task, pixel, sums);
    });
  }
  template <DeviceLook Look>
  static void follow_queue(const DeviceScene& scene, const DeviceTask& task,
                           const ParallelFor& parallel) {
    const auto count = static_cast<std::int64_t>(task.counts->in_double);
    launch(count, task, parallel, [&](std::int64_t index, DeviceCounts& sums) {
      follow<Look, false>(scene, task, task.in_double.pixel[index], sums);
    });
  }
};

}  // namespace

std::unique_ptr<DeviceBackend> make_emulated_backend() {
  return std::make_unique<EmulatedBackend>();
}

}  // namespace pellucid
