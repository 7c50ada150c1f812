// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "pellucid/cuda/device_scene.h"
#include "pellucid/scene/volume.h"

namespace pellucid {

/// A machine that follows rays, with a memory of its own. Used by one thread at a time. Members
/// throw Error if the machine has no memory left, or fails.
class DeviceBackend {
 public:
  DeviceBackend() = default;
  DeviceBackend(const DeviceBackend&) = delete;
  DeviceBackend& operator=(const DeviceBackend&) = delete;
  virtual ~DeviceBackend() = default;

  /// Returns the name of the machine, for messages.
  virtual std::string name() const = 0;

  /// Returns memory of the device, aligned for any type.
  virtual void* allocate(std::size_t bytes) = 0;
  virtual void release(void* memory) noexcept = 0;
  /// Copies bytes between the host and the device; the copy is done when the function returns.
  virtual void upload(void* to, const void* from, std::size_t bytes) = 0;
  virtual void download(void* to, const void* from, std::size_t bytes) = 0;
  /// Sets memory of the device to zero.
  virtual void clear(void* memory, std::size_t bytes) = 0;

  /// Follows the rays of a task, whose arrays and those of the scene are in the device's memory, on
  /// `parallel` where the device is the host. Counts and queues begin anew. All pixels are stored
  /// but those in the queue `left`.
  virtual void trace(const DeviceScene& scene, const DeviceTask& task,
                     const ParallelFor& parallel) = 0;
};

/// Returns a backend in the host's own memory: the functions of a card, ray by ray.
std::unique_ptr<DeviceBackend> make_emulated_backend();

/// Returns the first card. Throws Error, in one line, if there is none, no driver, one that is too
/// old, or the library was built without it.
std::unique_ptr<DeviceBackend> make_cuda_backend();

}  // namespace pellucid
