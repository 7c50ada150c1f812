// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>

namespace pellucid {

/// Compresses bytes by zlib, and gives what comes of them to a function part by part. Without a
/// date, so that the same bytes give the same file.
class Deflater {
 public:
  /// Header and checksum around what is deflated: none, as in a zip archive, zlib's, as in a PNG,
  /// or those of a member of gzip.
  enum class Wrapping { none, zlib, gzip };

  Deflater(Wrapping wrapping, std::function<void(std::span<const std::byte>)> to);
  ~Deflater();
  Deflater(const Deflater&) = delete;
  Deflater& operator=(const Deflater&) = delete;

  void put(std::span<const std::byte> bytes);
  /// Writes the end, with its checksum. Nothing may follow.
  void finish();

 private:
  struct State;

  void run(std::span<const std::byte> bytes, bool last);

  std::function<void(std::span<const std::byte>)> to_;
  std::unique_ptr<State> state_;
};

}  // namespace pellucid
