// SPDX-License-Identifier: Apache-2.0
//
// The formats: ITK-SNAP, "Label Description File" (its own header says what the columns are); 3D
// Slicer, vtkMRMLColorTableStorageNode ("Color table file", values 0 to 255).

#include "pellucid/io/label_table.h"

#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <unordered_set>

#include "pellucid/io/internal/atomic_file.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/srgb.h"
#include "text/latin_text.h"

namespace pellucid {
namespace {

/// Returns the words of a line; one in quotes may have spaces.
std::vector<std::string> words_of(std::string_view line) {
  std::vector<std::string> words;
  std::size_t at = 0;
  const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (at < line.size()) {
    if (is_space(line[at])) {
      ++at;
      continue;
    }
    std::size_t end = at;
    if (line[at] == '"') {
      end = line.find('"', at + 1);
      if (end == std::string_view::npos) end = line.size();
      words.emplace_back("\"" + std::string(line.substr(at + 1, end - at - 1)));
      at = end + 1;
      continue;
    }
    while (end < line.size() && !is_space(line[end])) ++end;
    words.emplace_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

std::optional<double> number_of(const std::string& word) {
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return value;
}

/// Returns the numbers of some words; none if one is no number or outside of its range.
std::optional<std::vector<double>> numbers_of(const std::vector<std::string>& words,
                                              std::size_t first, std::size_t count,
                                              double largest) {
  std::vector<double> numbers;
  for (std::size_t i = first; i < first + count; ++i) {
    const std::optional<double> number = number_of(words[i]);
    if (!number || !(*number >= 0 && *number <= largest)) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

Rgb<double> color_from(const std::vector<double>& bytes) {
  return srgb_to_linear(Rgb<double>{bytes[0] / 255, bytes[1] / 255, bytes[2] / 255});
}

/// Reads a line of ITK-SNAP: IDX R G B A VIS MSH "LABEL".
bool read_snap(const std::vector<std::string>& words, double extinction, LabelStyle& style) {
  if (words.size() != 8 || words[7].front() != '"') return false;
  const auto color = numbers_of(words, 1, 3, 255), rest = numbers_of(words, 4, 3, 1);
  if (!color || !rest) return false;
  style.color = color_from(*color);
  style.extinction = (*rest)[1] > 0 ? extinction * (*rest)[0] : 0;
  style.name = words[7].substr(1);
  return true;
}

/// Reads a line of 3D Slicer: number, name, R G B A; names have _ in place of spaces.
bool read_slicer(const std::vector<std::string>& words, double extinction, LabelStyle& style) {
  if (words.size() != 6) return false;
  const auto numbers = numbers_of(words, 2, 4, 255);
  if (!numbers) return false;
  style.color = color_from(*numbers);
  style.extinction = extinction * (*numbers)[3] / 255;
  style.name = words[1].front() == '"' ? words[1].substr(1) : words[1];
  for (char& c : style.name) {
    if (c == '_') c = ' ';
  }
  return true;
}

}  // namespace

std::vector<LabelStyle> read_label_table(const std::filesystem::path& path, double extinction) {
  return parse_label_table(read_text_file(path), path.string(), extinction);
}

std::vector<LabelStyle> parse_label_table(std::string_view text, const std::string& name,
                                          double extinction) {
  std::istringstream lines{std::string(text)};
  std::vector<LabelStyle> styles;
  std::unordered_set<std::int32_t> labels;
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::vector<std::string> words = words_of(line);
    if (words.empty() || words.front().front() == '#') continue;
    const auto fail = [&](const std::string& what) {
      throw Error(name + ": line " + std::to_string(number) + ": " + what);
    };
    LabelStyle style;
    const std::optional<double> label = number_of(words.front());
    constexpr double largest = 1 << 24;
    if (!label || *label != std::floor(*label) || !(std::abs(*label) <= largest) ||
        !(read_snap(words, extinction, style) || read_slicer(words, extinction, style))) {
      fail(
          "is no label; lines are 'NUMBER R G B OPACITY VISIBLE MESH \"NAME\"' (ITK-SNAP) or "
          "'NUMBER NAME R G B OPACITY' (3D Slicer)");
    }
    style.name = as_utf8(style.name);
    style.label = static_cast<std::int32_t>(*label);
    if (!labels.insert(style.label).second) {
      fail("label " + std::to_string(style.label) + " is there twice; remove one of them");
    }
    styles.push_back(std::move(style));
  }
  if (styles.empty()) throw Error(name + ": has no label; give a table of labels");
  return styles;
}

}  // namespace pellucid
