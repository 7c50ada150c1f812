// SPDX-License-Identifier: Apache-2.0
#include "volume_format.h"

#include <algorithm>
#include <string>
#include <system_error>

#include "files/input_file.h"
#include "text/text.h"
#include "unread_formats.h"

namespace pellucid {

namespace {

/// Returns the first format for which `takes` returns true; null: there is none.
template <class Takes>
const VolumeFormat* first_format(const Takes& takes) {
  const auto formats = volume_formats();
  const auto found =
      std::ranges::find_if(formats, [&](const VolumeFormat* format) { return takes(*format); });
  return found == formats.end() ? nullptr : *found;
}

const VolumeFormat* format_of_folder(const std::filesystem::path& path) {
  const VolumeFormat* const format = first_format([&](const VolumeFormat& known) {
    return known.takes_folder != nullptr && known.takes_folder(path);
  });
  if (format != nullptr) return format;
  return first_format([](const VolumeFormat& known) { return known.takes_other_folders; });
}

const VolumeFormat* format_of_file(const std::filesystem::path& path, const ReadOptions& options) {
  const VolumeFormat* const by_name = volume_format_by_name(path.filename().string());
  auto owner = ContentOwner::others;
  const VolumeFormat* const by_content = first_format([&](const VolumeFormat& known) {
    if (known.content_owner != nullptr) owner = known.content_owner(path, by_name);
    return owner != ContentOwner::others;
  });
  if (owner == ContentOwner::this_format) return by_content;
  if (owner == ContentOwner::others && by_name != nullptr &&
      (by_name->refuses == nullptr || !by_name->refuses(path))) {
    return by_name;
  }
  // Whoever says how large the data is and of what type has said that it has no header.
  if (options.dimensions && options.type) return &raw_format;
  return first_format([&](const VolumeFormat& known) {
    return known.takes_unknown_name != nullptr && known.takes_unknown_name(path);
  });
}

}  // namespace

const VolumeFormat* volume_format_by_name(std::string_view file_name) {
  const std::string name = in_small_letters(file_name);
  return first_format([&](const VolumeFormat& known) {
    return any_word(known.extensions, [&](std::string_view end) { return name.ends_with(end); });
  });
}

const VolumeFormat& find_volume_format(const std::filesystem::path& path,
                                       const ReadOptions& options) {
  const VolumeFormat* const by_path = first_format([&](const VolumeFormat& known) {
    return known.takes_path != nullptr && known.takes_path(path);
  });
  if (by_path != nullptr) return *by_path;
  refuse_unread_format(path);
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    if (const VolumeFormat* const format = format_of_folder(path)) return *format;
    refuse_unknown_format(path);
  }
  check_input_file(path);
  if (const VolumeFormat* const format = format_of_file(path, options)) return *format;
  refuse_unknown_format(path);
}

std::string volume_extensions() {
  std::string text;
  for (const VolumeFormat* const format : volume_formats()) {
    if (format->extensions.empty()) continue;
    text += (text.empty() ? "" : " ") + std::string(format->extensions);
  }
  return text;
}

bool has_volume_header(std::string_view file_name) {
  const VolumeFormat* const format = volume_format_by_name(file_name);
  return format != nullptr && format->has_header;
}

bool is_volume_json(const std::filesystem::path& path) {
  return first_format([&](const VolumeFormat& known) {
           return known.is_json && known.takes_path != nullptr && known.takes_path(path);
         }) != nullptr;
}

}  // namespace pellucid
