// SPDX-License-Identifier: Apache-2.0
#include "nrrd_fields.h"

#include <charconv>
#include <fstream>
#include <limits>
#include <system_error>
#include <utility>

#include "pellucid/scene/error.h"
#include "text/text.h"

namespace pellucid::nrrd {

namespace fs = std::filesystem;

namespace {

bool is_unknown(const std::string& kind) {
  return kind == "???" || kind == "none" || kind == "unknown";
}

}  // namespace

// NrrdIO takes a field's name in letters of either case, and "axis mins" for "axismins".
Line parse_line(std::string text) {
  Line line{std::move(text), {}, {}};
  const std::size_t colon = line.text.find(':');
  // "key:=value" is no field.
  if (colon == std::string::npos || line.text.starts_with('#') ||
      line.text.compare(colon, 2, ":=") == 0) {
    return line;
  }
  line.field = in_small_letters(line.text.substr(0, colon));
  std::erase(line.field, ' ');
  const std::size_t begin = line.text.find_first_not_of(blanks, colon + 1);
  if (begin == std::string::npos) return line;
  line.value = line.text.substr(begin, line.text.find_last_not_of(blanks) - begin + 1);
  return line;
}

Header read_header(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  Header header;
  std::string line;
  // A header of more is not NRRD, whatever it begins with.
  constexpr std::size_t largest = std::size_t{1} << 20;
  while (std::getline(file, line)) {
    header.bytes += line.size() + 1;
    if (header.bytes > largest) throw Error(path.string() + ": the NRRD header does not end");
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty()) break;
    header.lines.push_back(parse_line(std::move(line)));
    // Names of files follow.
    if (header.lines.back().field == "datafile" && header.lines.back().value.starts_with("LIST")) {
      break;
    }
  }
  header.lines_in_file = header.lines.size() + 1;
  return header;
}

const Line* find_field(const Header& header, std::string_view field) {
  for (const Line& line : header.lines) {
    if (line.field == field && !line.value.empty()) return &line;
  }
  return nullptr;
}

std::vector<std::string> axes_of(const std::string& value) {
  std::vector<std::string> axes;
  std::size_t at = value.find_first_not_of(blanks);
  while (at < value.size()) {
    std::size_t end = value[at] == '(' ? value.find(')', at) : value.find_first_of(" \t(", at);
    if (end != std::string::npos && value[end] == ')') ++end;
    axes.push_back(in_small_letters(value.substr(at, end - at)));
    at = end == std::string::npos ? end : value.find_first_not_of(blanks, end);
  }
  return axes;
}

std::vector<std::string> words_of(const Header& header, std::string_view field) {
  const Line* line = find_field(header, field);
  return line == nullptr ? std::vector<std::string>() : axes_of(line->value);
}

double number_at(const std::vector<std::string>& words, std::size_t axis) {
  const auto number = axis < words.size() ? number_of_word<double>(words[axis]) : std::nullopt;
  return number.value_or(std::numeric_limits<double>::quiet_NaN());
}

std::string kind_of(const Header& header, std::size_t axis) {
  const Line* line = find_field(header, "kinds");
  if (line == nullptr) return {};
  const std::vector<std::string> kinds = axes_of(line->value);
  return axis > kinds.size() || is_unknown(kinds[axis - 1]) ? std::string() : kinds[axis - 1];
}

std::size_t axis_count(const Header& header) {
  const Line* sizes = find_field(header, "sizes");
  return sizes == nullptr ? 0 : axes_of(sizes->value).size();
}

std::optional<std::uint64_t> number_in(const std::string& text) {
  std::uint64_t number = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return number;
}

std::vector<std::string> listed_files(const Header& header, const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  file.seekg(static_cast<std::streamoff>(header.bytes));
  std::vector<std::string> files;
  for (std::string line; std::getline(file, line);) {
    const std::string_view listed = trimmed(line);
    if (!listed.empty()) files.emplace_back(listed);
  }
  return files;
}

}  // namespace pellucid::nrrd
