// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "pellucid/io/internal/temporary_folder.h"

namespace pellucid::view {

/// Keeps the files that are dropped on a page, in private folders: one for each set of files that
/// belong together, such as a header with its data, or a series of slices.
class Uploads {
 public:
  /// `most_bytes`: of all files that are kept at a time.
  explicit Uploads(std::uint64_t most_bytes) : most_bytes_(most_bytes) {}

  std::uint64_t most_bytes() const noexcept { return most_bytes_; }

  /// Returns where a file of so many bytes is to be written, which does not exist yet; makes its
  /// folder. A new set takes the place of all but the one that is kept. Throws Error if the name
  /// is no plain relative path or has been used, if the files are larger than `most_bytes` or too
  /// many, or if the disk has no room for them.
  std::filesystem::path place(int set, std::string_view name, std::uint64_t bytes);
  /// Returns where a file of a set is, or its folder if the name is empty. Throws Error.
  std::filesystem::path find(int set, std::string_view name) const;

  /// Returns the folder of a set, which lives as long as somebody has it. Throws Error.
  std::shared_ptr<const TemporaryFolder> folder(int set) const;
  /// Keeps this set, which is shown now, until another one is.
  void keep(int set) noexcept { kept_ = set; }

 private:
  struct Set {
    std::shared_ptr<const TemporaryFolder> folder;
    std::uint64_t bytes = 0;
    int files = 0;
  };
  const Set& checked(int set) const;
  std::uint64_t bytes() const noexcept;

  std::uint64_t most_bytes_;
  std::map<int, Set> sets_;
  int kept_ = -1;
};

/// Returns a relative path of plain names with '/' between them. Throws Error otherwise.
std::filesystem::path checked_upload_name(std::string_view name);
/// Returns the text with each %XX as a byte. Throws Error if one is not complete.
std::string percent_decoded(std::string_view text);

}  // namespace pellucid::view
