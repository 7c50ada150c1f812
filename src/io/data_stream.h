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

namespace pellucid {

/// Whether the file begins as gzip does. Throws Error where it cannot be read.
bool is_gzip(const std::filesystem::path& path);

/// Bytes of a file one after the other, inflated where they are compressed (zlib or gzip, also of
/// several members). Data that ends early or is damaged is an Error, never zeros.
class DataStream {
 public:
  enum class Compression { none, deflate };

  /// Begins at byte `offset` of the file.
  DataStream(const std::filesystem::path& path, std::uintmax_t offset, Compression compression);
  ~DataStream();
  DataStream(const DataStream&) = delete;
  DataStream& operator=(const DataStream&) = delete;

  const std::string& name() const noexcept { return name_; }
  /// Fills the whole span.
  void read(std::span<std::byte> to);
  void skip(std::uintmax_t bytes);
  /// Whether nothing comes any more; takes a byte where something does.
  bool at_end();
  /// Checks the checksum of compressed data, where its end is near; there may be more data.
  void finish();

 private:
  struct Inflater;

  std::size_t read_some(std::span<std::byte> to);
  std::size_t inflate_some(std::span<std::byte> to);

  std::string name_;
  std::ifstream file_;
  std::unique_ptr<Inflater> inflater_;  // null: not compressed
};

}  // namespace pellucid
