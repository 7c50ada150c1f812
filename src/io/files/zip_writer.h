// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "deflater.h"

namespace pellucid {

/// Writes a zip archive of deflated files, part by part, to a function. Without dates, so that the
/// same bytes give the same archive. zip64 where a file or the archive needs it.
class ZipWriter {
 public:
  using Sink = std::function<void(std::span<const std::byte>)>;

  explicit ZipWriter(Sink to);
  ~ZipWriter();
  ZipWriter(const ZipWriter&) = delete;
  ZipWriter& operator=(const ZipWriter&) = delete;

  /// Begins a file; the one before it ends. `size`: what its bytes will be.
  void begin(const std::string& name, std::uint64_t size);
  void put(std::span<const std::byte> bytes);
  /// Ends the archive. Nothing may follow.
  void finish();

 private:
  struct Entry;

  void write(std::span<const std::byte> bytes);
  void write(const std::string& bytes);
  void end_entry();

  Sink to_;
  std::uint64_t position_ = 0;
  std::vector<Entry> entries_;
  std::unique_ptr<Deflater> deflater_;  ///< of the file that is being written
};

}  // namespace pellucid
