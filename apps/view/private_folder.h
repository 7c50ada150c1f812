// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace pellucid::view {

/// A folder for temporary files that nobody else can read, and that goes with this object.
class PrivateFolder {
 public:
  /// Throws Error if no folder can be made.
  PrivateFolder();
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace pellucid::view
