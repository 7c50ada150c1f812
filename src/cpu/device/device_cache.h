// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>

#include "pellucid/cpu/render.h"
#include "pellucid/cuda/resident_arrays.h"

namespace pellucid {

/// A device with what frames leave in its memory: data, tables, the image.
class CachedDevice {
 public:
  explicit CachedDevice(std::unique_ptr<DeviceBackend> backend);
  ~CachedDevice();
  CachedDevice(const CachedDevice&) = delete;
  CachedDevice& operator=(const CachedDevice&) = delete;

  DeviceBackend& backend() noexcept { return *backend_; }
  ResidentArrays& arrays() noexcept { return arrays_; }
  /// Returns an image of this size, of zeros, with queues for as many pixels.
  DeviceTask prepare(ImageSize size, bool depth, bool error);

  /// Held while a frame uses the device.
  std::mutex in_use;

 private:
  /// Memory that grows.
  struct Buffer {
    void* memory = nullptr;
    std::size_t bytes = 0;
  };
  template <class T>
  T* fit(Buffer& buffer, std::size_t count);

  std::unique_ptr<DeviceBackend> backend_;
  ResidentArrays arrays_;
  Buffer color_, depth_, error_, proved_, in_double_, left_, counts_;
};

/// The devices that a renderer has used. Safe to use from any thread.
class DeviceCache {
 public:
  /// Returns the device. The first call makes it. Throws Error if it cannot be had.
  std::shared_ptr<CachedDevice> find(Device device);
  /// Lets go of all that is kept; frames that run keep their device.
  void clear();

 private:
  std::mutex mutex_;
  std::shared_ptr<CachedDevice> cuda_, emulated_;
};

}  // namespace pellucid
