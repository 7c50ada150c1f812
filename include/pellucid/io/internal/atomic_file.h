// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace pellucid {

/// A file that appears complete or not at all. Write to temporary_path(), then call commit().
/// Without a commit the destructor removes the temporary file.
class AtomicFile {
 public:
  /// Throws Error if the target's folder is missing or not writable.
  explicit AtomicFile(std::filesystem::path target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::filesystem::path& temporary_path() const noexcept { return temporary_; }
  void commit();  ///< renames the temporary file to the target; throws Error

 private:
  std::filesystem::path target_, temporary_;
  bool committed_ = false;
};

/// Writes a text file, complete or not at all. Throws Error.
void write_text_file(const std::filesystem::path& path, std::string_view text);
/// Reads a whole text file of at most `largest` bytes, without the mark that some programs put
/// before UTF-8. Throws Error if it is missing, a folder, larger or UTF-16.
std::string read_text_file(const std::filesystem::path& path, std::size_t largest = std::size_t(64)
                                                                                    << 20);
/// Reads a whole file of at most `largest` bytes. Throws Error if it is missing, a folder or
/// larger.
std::string read_bytes(const std::filesystem::path& path, std::size_t largest);

}  // namespace pellucid
