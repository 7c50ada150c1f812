// SPDX-License-Identifier: Apache-2.0
#include "json_file.h"

#include <array>
#include <utility>

#include "pellucid/io/internal/atomic_file.h"
#include "pellucid/scene/error.h"
#include "printable.h"

namespace pellucid {

namespace {

constexpr std::size_t deepest_nesting = 64;

/// Puts the numbers that JSON has no word for in quotes, outside of strings.
std::string with_quoted_numbers(std::string_view text) {
  static constexpr std::array<std::string_view, 3> words{"-Infinity", "Infinity", "NaN"};
  std::string result;
  result.reserve(text.size());
  bool in_string = false;
  for (std::size_t i = 0; i < text.size();) {
    if (in_string && text[i] == '\\' && i + 1 < text.size()) {
      result += text.substr(i, 2);
      i += 2;
      continue;
    }
    if (text[i] == '"') in_string = !in_string;
    std::string_view word;
    for (const std::string_view known : words) {
      if (!in_string && word.empty() && text.substr(i).starts_with(known)) word = known;
    }
    if (word.empty()) {
      result += text[i++];
    } else {
      result += '"';
      result += word;
      result += '"';
      i += word.size();
    }
  }
  return result;
}

}  // namespace

JsonFile parse_data_json(std::string_view text, const std::string& name) {
  return {scene_json::parse_document(with_quoted_numbers(text), name, deepest_nesting), name};
}

JsonFile read_data_json(const std::filesystem::path& path) {
  constexpr std::size_t largest = std::size_t{1} << 28;
  return parse_data_json(read_text_file(path, largest), path.string());
}

std::filesystem::path path_inside(const std::filesystem::path& folder, const std::string& relative,
                                  const std::string& name) {
  const std::filesystem::path part(relative);
  const auto refuse = [&](const std::string& what) {
    throw Error(name + ": names \"" + printable(relative) + "\", which " + what +
                "; what is read must lie in the folder");
  };
  if (relative.find('\0') != std::string::npos) refuse("is no path");
  if (part.is_absolute()) refuse("is an absolute path");
  for (const std::filesystem::path& step : part) {
    if (step == "..") refuse("leaves the folder");
  }
  return folder / part;
}

}  // namespace pellucid
