// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "files/inflater.h"
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

/// The values of a chunk that deflate or bzip2 alone compress, piece by piece.
class ZarrInflation {
 public:
  /// Returns whether codecs can be undone by it.
  static bool takes(const std::vector<ZarrCodec>& codecs) noexcept;

  /// Inflates bytes that `next` reads. Throws Error that begins with `name`, as all here do.
  ZarrInflation(const ZarrCodec& codec, NextBytes next, std::string name);

  /// Fills `to` with the next bytes. Throws Error where there are fewer.
  void read(std::span<std::byte> to);
  /// Throws Error where there are more.
  void expect_end();

 private:
  const ZarrCodec& codec_;
  NextBytes next_;
  std::string name_;
  std::unique_ptr<Inflater> inflater_;
};

/// Returns the polynomial of iSCSI.
std::uint32_t crc32c(std::span<const std::byte> bytes) noexcept;

}  // namespace pellucid
