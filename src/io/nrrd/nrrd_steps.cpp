// SPDX-License-Identifier: Apache-2.0
#include "nrrd_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "axes/time_steps.h"
#include "text/printable.h"
#include "text/readable_number.h"
#include "text/text.h"

namespace pellucid::nrrd {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Returns the fourth number of a vector "(0,0,0,2)"; NaN where it has none.
double fourth_of(std::string_view vector) {
  if (!vector.starts_with('(') || !vector.ends_with(')')) return none;
  vector = vector.substr(1, vector.size() - 2);
  for (int i = 0; i < 3; ++i) {
    const std::size_t comma = vector.find(',');
    if (comma == std::string_view::npos) return none;
    vector.remove_prefix(comma + 1);
  }
  return number_of_word<double>(std::string(trimmed(vector))).value_or(none);
}

/// Returns the value of a pair "key:=value"; empty where there is none.
std::string value_of_pair(const Header& header, const std::string& key) {
  for (const Line& line : header.lines) {
    const std::size_t sign = line.text.find(":=");
    if (!line.field.empty() || sign == std::string::npos) continue;
    if (in_small_letters(std::string(trimmed(line.text.substr(0, sign)))) != key) continue;
    return std::string(trimmed(line.text.substr(sign + 2)));
  }
  return {};
}

/// Returns the numbers of a text between blanks or commas; none where any word is no number.
std::vector<double> numbers_in(std::string text) {
  std::ranges::replace(text, ',', ' ');
  std::vector<double> numbers;
  for (const std::string& word : axes_of(text)) {
    const auto number = number_of_word<double>(word);
    if (!number || !std::isfinite(*number)) return {};
    numbers.push_back(*number);
  }
  return numbers;
}

/// Returns the quoted text of an axis, from 0, among "mm" "mm" "s".
std::string quoted(const Header& header, std::string_view field, std::size_t axis) {
  const Line* line = find_field(header, field);
  if (line == nullptr) return {};
  std::size_t end = 0;
  for (std::size_t a = 0;; ++a) {
    const std::size_t begin = line->value.find('"', end == 0 ? 0 : end + 1);
    if (begin == std::string::npos) return {};
    end = line->value.find('"', begin + 1);
    if (end == std::string::npos) return {};
    if (a == axis) return printable(line->value.substr(begin + 1, end - begin - 1));
  }
}

/// Returns the times that 3D Slicer writes of an axis, from 0.
VolumeSteps numbered_steps(const Header& header, std::size_t axis, std::size_t count) {
  VolumeSteps steps;
  const std::string of_axis = "axis " + std::to_string(axis) + " index ";
  steps.times = numbers_in(value_of_pair(header, of_axis + "values"));
  if (steps.times.size() == count) {
    steps.unit = printable(value_of_pair(header, of_axis + "unit"));
    return steps;
  }
  steps.times = numbers_in(value_of_pair(header, "multivolume.framelabels"));
  if (steps.times.size() != count) return {};
  steps.unit = printable(value_of_pair(header, "multivolume.frameidentifyingdicomtagunits"));
  return steps;
}

}  // namespace

VolumeSteps steps_of(const Header& header, std::size_t components_axis) {
  const std::vector<std::string> sizes = words_of(header, "sizes");
  if (sizes.size() != 4) return {};
  const std::size_t axis = (components_axis == 0 ? 4 : components_axis) - 1;
  if (axis >= sizes.size()) return {};  // of a header that names more directions than axes
  const std::optional<std::uint64_t> side = number_in(sizes[axis]);
  if (!side || *side < 2) return {};
  const auto count = static_cast<std::size_t>(*side);
  const std::vector<std::string> directions = words_of(header, "spacedirections");
  const double along = axis < directions.size() ? fourth_of(directions[axis]) : none;
  const bool runs_in_time = std::isfinite(along) && along != 0;
  VolumeSteps numbered = numbered_steps(header, axis, count);
  if (!numbered.times.empty()) return numbered;
  if (kind_of(header, axis + 1) != "time" && !runs_in_time) return {};
  VolumeSteps steps;
  const double spacing = number_at(words_of(header, "spacings"), axis),
               least = number_at(words_of(header, "axismins"), axis),
               most = number_at(words_of(header, "axismaxs"), axis);
  const bool has_range = std::isfinite(least) && std::isfinite(most) && most != least;
  double first = std::isfinite(least) ? least : 0, step = 1;
  const std::vector<std::string> centerings = words_of(header, "centerings");
  const bool of_cells = axis < centerings.size() && centerings[axis] == "cell";
  if (runs_in_time) {
    step = along;
    const std::vector<std::string> origin = words_of(header, "spaceorigin");
    const double begin = origin.empty() ? none : fourth_of(origin.front());
    first = std::isfinite(begin) ? begin : 0;
    steps.unit = quoted(header, "spaceunits", 3);
  } else if (std::isfinite(spacing) && spacing != 0) {
    step = spacing;
    steps.unit = quoted(header, "units", axis);
  } else if (has_range) {
    step = (most - least) / static_cast<double>(of_cells ? count : count - 1);
    if (of_cells) first += step / 2;
    steps.unit = quoted(header, "units", axis);
  }
  steps.times = even_times(count, first, step);
  return steps;
}

}  // namespace pellucid::nrrd
