// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace pellucid {

/// A folder for temporary files that nobody else can read, and that goes with this object.
class TemporaryFolder {
 public:
  /// Makes a folder. `purpose`: what it is for, in the message. Throws Error if no folder can be
  /// made.
  explicit TemporaryFolder(const std::string& purpose);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace pellucid
