// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>

namespace pellucid {

/// Compresses bytes to one member of gzip, and gives it to a function part by part. Without a date,
/// so that the same bytes give the same file.
class GzipWriter {
 public:
  explicit GzipWriter(std::function<void(std::span<const std::byte>)> to);
  ~GzipWriter();
  GzipWriter(const GzipWriter&) = delete;
  GzipWriter& operator=(const GzipWriter&) = delete;

  void put(std::span<const std::byte> bytes);
  /// The end, with its checksum. Nothing may follow.
  void finish();

 private:
  struct State;

  void run(std::span<const std::byte> bytes, bool last);

  std::function<void(std::span<const std::byte>)> to_;
  std::unique_ptr<State> state_;
};

}  // namespace pellucid
