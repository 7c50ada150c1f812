// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>

#include "pellucid/cuda/device_backend.h"

namespace pellucid {

/// Copies of the host's arrays in the memory of a device, kept from frame to frame and found by the
/// address of the original, which an owner keeps alive and which does not change. Used by one
/// thread at a time.
class ResidentArrays {
 public:
  /// Holds no copies yet. The backend must outlive the object.
  explicit ResidentArrays(DeviceBackend& backend) : backend_(backend) {}
  ResidentArrays(const ResidentArrays&) = delete;
  ResidentArrays& operator=(const ResidentArrays&) = delete;
  ~ResidentArrays();

  /// Returns the scene with all arrays in the device's memory. `owner` keeps the originals. Throws
  /// Error if the device has no room.
  DeviceScene resident(const DeviceScene& host, const std::shared_ptr<const void>& owner);
  /// Releases what none of the last few frames used; call it after each.
  void end_frame();
  /// Releases everything.
  void clear() noexcept;

  /// Return the bytes that were uploaded so far, and those that are kept.
  std::uint64_t uploaded_bytes() const noexcept { return uploaded_; }
  std::uint64_t kept_bytes() const noexcept { return kept_; }

 private:
  /// Address and size: an array may begin where another does.
  using Key = std::pair<const void*, std::size_t>;
  struct Entry {
    void* memory;
    std::shared_ptr<const void> owner;
    std::uint64_t last_used;
  };

  /// Returns the copy of `key`, made from the bytes at `from` if there is none.
  void* find(const Key& key, const void* from, const std::shared_ptr<const void>& owner);

  DeviceBackend& backend_;
  std::map<Key, Entry> entries_;
  std::uint64_t frame_ = 0, uploaded_ = 0, kept_ = 0;
};

}  // namespace pellucid
