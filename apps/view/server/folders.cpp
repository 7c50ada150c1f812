// SPDX-License-Identifier: Apache-2.0
#include "folders.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <system_error>
#include <vector>

#include "cli/arguments/parse.h"
#include "pellucid/io/read_mesh.h"
#include "pellucid/io/read_volume.h"
#include "pellucid/scene/error.h"

namespace pellucid::view {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_entries = 5000;

std::vector<std::string> known_extensions() {
  std::istringstream words(volume_extensions() + " " + mesh_extensions() + " .json .dcm");
  std::vector<std::string> result;
  for (std::string word; words >> word;) result.push_back(word);
  return result;
}

bool is_known(const std::string& name) {
  static const std::vector<std::string> extensions = known_extensions();
  const std::string lower = cli::lower_case(name);
  return std::ranges::any_of(extensions,
                             [&](const std::string& end) { return lower.ends_with(end); });
}

/// Tells whether JSON can hold the text.
bool is_utf8(const std::string& text) {
  try {
    return !Json(text).dump().empty();
  } catch (const Json::exception&) {
    return false;
  }
}

struct Entry {
  std::string name, key;  ///< key: what it is sorted by
  bool is_folder = false;
  std::uintmax_t bytes = 0;
};

/// Returns false for what is not shown.
bool read_entry(const fs::directory_entry& entry, Entry& result) {
  std::error_code failure;
  result.name = entry.path().filename().string();
  result.key = cli::lower_case(result.name);
  if (result.name.starts_with('.') || !is_utf8(result.name)) return false;
  result.is_folder = entry.is_directory(failure);
  if (failure || (!result.is_folder && !entry.is_regular_file(failure))) return false;
  if (!result.is_folder) result.bytes = entry.file_size(failure);
  return !failure;
}

Json entry_json(const Entry& entry) {
  if (entry.is_folder) {
    return {{"name", entry.name}, {"folder", true}, {"known", entry.key.ends_with(".zarr")}};
  }
  return {{"name", entry.name}, {"bytes", entry.bytes}, {"known", is_known(entry.name)}};
}

}  // namespace

Json folder_json(const std::string& folder) {
  std::error_code failure;
  const fs::path path = fs::canonical(folder.empty() ? "." : folder, failure);
  fs::directory_iterator at;
  if (!failure) at = fs::directory_iterator(path, failure);
  if (failure) throw Error(folder + ": " + failure.message() + "; choose another folder");
  std::vector<Entry> entries;
  std::size_t left_out = 0;
  for (; !failure && at != fs::directory_iterator(); at.increment(failure)) {
    Entry entry;
    if (!read_entry(*at, entry)) continue;
    if (entries.size() < max_entries) {
      entries.push_back(std::move(entry));
    } else {
      ++left_out;
    }
  }
  std::ranges::sort(entries, [](const Entry& a, const Entry& b) {
    return a.is_folder != b.is_folder ? a.is_folder : a.key < b.key;
  });
  Json list = Json::array();
  for (const Entry& entry : entries) list.push_back(entry_json(entry));
  const char* const home = std::getenv("HOME");
  return {{"type", "folder"},
          {"path", path.string()},
          {"parent", path.has_relative_path() ? Json(path.parent_path().string()) : Json()},
          {"home", home == nullptr ? Json() : Json(home)},
          {"left_out", left_out},
          {"entries", std::move(list)}};
}

}  // namespace pellucid::view
