// SPDX-License-Identifier: Apache-2.0
#include "nrrd_space.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "pellucid/scene/error.h"
#include "text/header_keys.h"
#include "text/text.h"
#include "volumes/components.h"

namespace pellucid::nrrd {

namespace {

struct KnownSpace {
  std::string_view name, letters;  // the letters are empty if it has none
  bool is_patient;
};
constexpr std::array known_spaces{KnownSpace{"right-anterior-superior", "RAS", true},
                                  KnownSpace{"left-anterior-superior", "LAS", true},
                                  KnownSpace{"left-posterior-superior", "LPS", true},
                                  KnownSpace{"scanner-xyz", "", false},
                                  KnownSpace{"3D-right-handed", "", false},
                                  KnownSpace{"3D-left-handed", "", false}};

// NrrdIO takes "RAS" and "right anterior superior", in letters of either case.
std::string plain(std::string_view name) {
  std::string text = in_small_letters(name);
  std::erase_if(text, [](char c) { return c == '-' || c == ' ' || c == '_'; });
  return text;
}

struct FoundSpace {
  const KnownSpace* space = nullptr;  // null: none of the known ones
  bool has_time = false;
};

FoundSpace find_space(const Header& header) {
  const Line* line = find_field(header, "space");
  if (line == nullptr) return {};
  const std::string said = plain(line->value);
  for (const KnownSpace& known : known_spaces) {
    for (const std::string_view name : {known.name, known.letters}) {
      if (name.empty()) continue;
      if (said == plain(name)) return {&known, false};
      if (said == plain(name) + (name == known.name ? "time" : "t")) return {&known, true};
    }
  }
  return {};
}

// The numbers of "(1,0,0,0)", as written.
std::vector<std::string> numbers_of(std::string_view vector) {
  std::vector<std::string> numbers;
  if (!vector.starts_with('(') || !vector.ends_with(')')) return numbers;
  vector = vector.substr(1, vector.size() - 2);
  while (true) {
    const std::size_t comma = vector.find(',');
    numbers.emplace_back(trimmed(vector.substr(0, comma)));
    if (comma == std::string_view::npos) return numbers;
    vector.remove_prefix(comma + 1);
  }
}

bool is_zero(const std::string& number) {
  const std::size_t end = std::min(number.find('e'), number.size());
  return number.find_first_of("123456789n") >= end && end > 0;
}

std::string without_last(const std::vector<std::string>& numbers) {
  return "(" + numbers[0] + "," + numbers[1] + "," + numbers[2] + ")";
}

// The vectors of a field in three coordinates; "none" for one along the fourth.
std::string in_space(const Line& line, const std::string& name) {
  std::string text;
  std::size_t axis = 0;
  for (const std::string& vector : axes_of(line.value)) {
    ++axis;
    const std::vector<std::string> numbers = numbers_of(vector);
    if (!text.empty()) text += ' ';
    if (numbers.size() != 4) {
      text += vector;
      continue;
    }
    const bool stands = is_zero(numbers[0]) && is_zero(numbers[1]) && is_zero(numbers[2]);
    const bool moves = !is_zero(numbers[3]);
    if (moves && !stands && line.field == "spacedirections") {
      throw Error(name + ": axis " + std::to_string(axis) +
                  " runs through space and time at once (\"" + line.text +
                  "\"), which is not read; save the steps of time as volumes");
    }
    text += moves && line.field == "spacedirections" ? "none" : without_last(numbers);
  }
  return text;
}

bool has_other_units(const Line* line) {
  if (line == nullptr) return false;
  const std::vector<std::string> units = axes_of(line->value);
  const std::size_t count = std::min<std::size_t>(units.size(), 3);
  return std::any_of(units.begin(), units.begin() + static_cast<std::ptrdiff_t>(count),
                     [&](const std::string& unit) { return unit != units.front(); });
}

constexpr std::array known_fields = std::to_array<std::string_view>(
    {"type",       "dimension", "sizes",     "endian",         "encoding",        "datafile",
     "byteskip",   "lineskip",  "spacings",  "axismins",       "axismaxs",        "centerings",
     "centers",    "kinds",     "space",     "spacedimension", "spacedirections", "spaceorigin",
     "content",    "number",    "blocksize", "thicknesses",    "labels",          "units",
     "spaceunits", "min",       "max"});
// Of ITK, of diffusion series, of segmentations and sequences of 3D Slicer.
constexpr std::array harmless_keys = std::to_array<std::string_view>(
    {"itk_", "nrrd_", "dwmri_", "modality", "segment", "axis ", "reference image extent"});

// The key of a pair "key:=value"; empty where the line is none.
std::string key_of_pair(const Line& line) {
  const std::size_t colon = line.text.find(":=");
  if (!line.field.empty() || line.text.starts_with('#') || colon == std::string::npos) return {};
  return std::string(trimmed(std::string_view(line.text).substr(0, colon)));
}

}  // namespace

Space space_of(const Header& header) {
  const FoundSpace found = find_space(header);
  if (found.space == nullptr) return {};
  const bool is_left_handed = found.space->name == "3D-left-handed";
  if (!found.space->is_patient) return {std::string(found.space->name), is_left_handed, false};
  if (find_field(header, "spacedirections") == nullptr) return {};
  return {patient_space, is_left_handed, found.space->letters == "LAS"};
}

void drop_time(Header& header, const std::string& name) {
  const Line* dimension = find_field(header, "spacedimension");
  const FoundSpace found = find_space(header);
  if (!found.has_time && (dimension == nullptr || dimension->value != "4")) return;
  header.is_changed = true;
  // Both have a unit or a vector for each coordinate.
  std::erase_if(header.lines, [](const Line& line) {
    return line.field == "spaceunits" || line.field == "measurementframe";
  });
  for (Line& line : header.lines) {
    if (line.field == "space" && found.has_time) {
      line = parse_line("space: " + std::string(found.space->name));
    } else if (line.field == "spacedimension") {
      line = parse_line("space dimension: 3");
    } else if (line.field == "spacedirections") {
      line = parse_line("space directions: " + in_space(line, name));
    } else if (line.field == "spaceorigin") {
      line = parse_line("space origin: " + in_space(line, name));
    }
  }
}

void note_keys(const Header& header, const Space& space, const std::string& name,
               const std::function<void(const std::string&)>& note) {
  if (!note) return;
  const Line* said = find_field(header, "space");
  if (said != nullptr && space.name.empty()) {
    note(name + ": says \"" + said->text +
         "\", but no space directions; how it lies in that space is not known");
  }
  if (space.is_left_handed) {
    note(name +
         ": its space is left-handed; coordinates are taken as they are, so that a picture shows "
         "its mirror image");
  }
  std::vector<std::string> ignored;
  for (const Line& line : header.lines) {
    if (!line.field.empty()) {
      const bool units =
          (line.field == "units" || line.field == "spaceunits") && has_other_units(&line);
      if (!units && std::ranges::find(known_fields, line.field) != known_fields.end()) continue;
      ignored.emplace_back(trimmed(std::string_view(line.text).substr(0, line.text.find(':'))));
    } else if (const std::string key = key_of_pair(line); !key.empty()) {
      const std::string small = in_small_letters(key);
      const bool harmless = std::ranges::any_of(
          harmless_keys, [&](std::string_view begin) { return small.starts_with(begin); });
      if (!harmless) ignored.push_back(key);
    }
  }
  note_ignored_keys(note, name, ignored);
}

}  // namespace pellucid::nrrd
