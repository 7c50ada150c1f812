// SPDX-License-Identifier: Apache-2.0
#include "uploads.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <system_error>

#include "pellucid/scene/error.h"

namespace pellucid::view {

namespace {

namespace fs = std::filesystem;

constexpr int max_files = 20000, deepest_folder = 16;
constexpr std::size_t longest_name = 200;

}  // namespace

fs::path checked_upload_name(std::string_view name) {
  fs::path path;
  int depth = 0;
  while (true) {
    const std::size_t end = std::min(name.find('/'), name.size());
    const std::string_view part = name.substr(0, end);
    const bool is_plain = !part.empty() && part != "." && part != ".." &&
                          part.size() <= longest_name && part.find('\0') == part.npos;
    if (!is_plain || ++depth > deepest_folder) {
      throw Error("upload: the name of a file is empty, too long or leads elsewhere; rename it");
    }
    path /= part;
    if (end == name.size()) return path;
    name.remove_prefix(end + 1);
  }
}

std::string percent_decoded(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    if (text.front() != '%') {
      result += text.front();
      text.remove_prefix(1);
      continue;
    }
    unsigned byte = 0;
    const char* const first = text.data() + 1;
    if (text.size() < 3 || std::from_chars(first, first + 2, byte, 16).ptr != first + 2) {
      throw Error("upload: the address has an incomplete %XX");
    }
    result += static_cast<char>(byte);
    text.remove_prefix(3);
  }
  return result;
}

fs::path Uploads::place(int set, std::string_view name, std::uint64_t bytes) {
  const fs::path relative = checked_upload_name(name);
  if (!sets_.contains(set)) {
    std::erase_if(sets_, [&](const auto& other) { return other.first != kept_; });
    sets_[set].folder = std::make_shared<const TemporaryFolder>("dropped files");
  }
  Set& to = sets_[set];
  if (bytes > most_bytes_ - std::min(this->bytes(), most_bytes_)) {
    throw Error(fmt::format(
        "upload: more than {} MB in all are not copied; choose the file from a folder instead",
        most_bytes_ / 1'000'000));
  }
  const fs::path path = to.folder->path() / relative;
  std::error_code failure;
  const fs::space_info space = fs::space(to.folder->path(), failure);
  if (!failure && bytes > space.available) {
    throw Error("upload: " + to.folder->path().parent_path().string() +
                " has not enough space; set TMPDIR to a folder that has");
  }
  if (++to.files > max_files) {
    throw Error(fmt::format("upload: there are more than {} files; choose their folder instead",
                            max_files));
  }
  fs::create_directories(path.parent_path(), failure);
  if (failure || fs::exists(fs::symlink_status(path))) {
    throw Error("upload: a file or folder of that name was dropped already");
  }
  to.bytes += bytes;
  return path;
}

fs::path Uploads::find(int set, std::string_view name) const {
  const fs::path& folder = checked(set).folder->path();
  return name.empty() ? folder : folder / checked_upload_name(name);
}

std::shared_ptr<const TemporaryFolder> Uploads::folder(int set) const {
  return checked(set).folder;
}

const Uploads::Set& Uploads::checked(int set) const {
  const auto found = sets_.find(set);
  if (found == sets_.end()) throw Error("upload: the files are gone; drop them again");
  return found->second;
}

std::uint64_t Uploads::bytes() const noexcept {
  std::uint64_t sum = 0;
  for (const auto& [number, set] : sets_) sum += set.bytes;
  return sum;
}

}  // namespace pellucid::view
