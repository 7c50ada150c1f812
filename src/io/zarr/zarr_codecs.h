// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "zarr_metadata.h"

namespace pellucid {

/// Bytes whose memory is not touched before it is written.
class ZarrBytes {
 public:
  explicit ZarrBytes(std::size_t size = 0)
      : bytes_(std::make_unique_for_overwrite<std::byte[]>(size)), size_(size) {}

  std::size_t size() const noexcept { return size_; }
  std::span<std::byte> span() noexcept { return {bytes_.get(), size_}; }
  std::span<const std::byte> span() const noexcept { return {bytes_.get(), size_}; }

 private:
  std::unique_ptr<std::byte[]> bytes_;
  std::size_t size_;
};

/// Undoes the codecs of a chunk, the last one first, and returns the `bytes` that its values take.
/// Throws Error that begins with `name` where they are damaged or come out as more or fewer, and
/// where the build lacks the library of one.
ZarrBytes undo_codecs(const std::vector<ZarrCodec>& codecs, ZarrBytes stored, std::size_t bytes,
                      const std::string& name);

/// Returns the polynomial of iSCSI.
std::uint32_t crc32c(std::span<const std::byte> bytes) noexcept;

}  // namespace pellucid
