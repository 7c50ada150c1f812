// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "inflater.h"

namespace pellucid {

/// Returns whether the file begins as gzip does. Throws Error where it cannot be read.
bool is_gzip(const std::filesystem::path& path);

/// Bytes of a file one after the other, inflated where they are compressed (zlib or gzip, bzip2,
/// also of several members). Data that ends early or is damaged is an Error, never zeros.
class DataStream {
 public:
  enum class Compression { none, deflate, bzip2 };

  /// Begins at byte `offset` of the file.
  DataStream(const std::filesystem::path& path, std::uintmax_t offset, Compression compression);
  ~DataStream() = default;
  DataStream(const DataStream&) = delete;
  DataStream& operator=(const DataStream&) = delete;

  const std::string& name() const noexcept { return name_; }
  /// Fills the whole span.
  void read(std::span<std::byte> to);
  void skip(std::uintmax_t bytes);
  /// Goes to the end, and says how many bytes there were.
  std::uintmax_t skip_all();
  /// Returns whether nothing comes any more; takes a byte where something does.
  bool at_end();
  /// Checks the checksum of compressed data, where its end is near; there may be more data.
  void finish();

 private:
  std::size_t read_some(std::span<std::byte> to);

  std::string name_;
  std::ifstream file_;
  std::unique_ptr<Inflater> inflater_;  // null: not compressed
};

}  // namespace pellucid
