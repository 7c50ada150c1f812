// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace pellucid {

/// A file that appears whole or not at all: write to temporary_path(), then commit(). Without a
/// commit the destructor removes the temporary file.
class AtomicFile {
 public:
  /// Throws Error where the folder of target is missing or not writable.
  explicit AtomicFile(std::filesystem::path target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::filesystem::path& temporary_path() const noexcept { return temporary_; }
  void commit();  ///< Renames over the target. Throws Error.

 private:
  std::filesystem::path target_, temporary_;
  bool committed_ = false;
};

/// Writes the text whole or not at all. Throws Error.
void write_text_file(const std::filesystem::path& path, std::string_view text);
/// Reads a whole text file. Throws Error (missing, a folder, larger than the limit in bytes).
std::string read_text_file(const std::filesystem::path& path, std::size_t largest = std::size_t(64)
                                                                                    << 20);

}  // namespace pellucid
