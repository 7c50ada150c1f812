// SPDX-License-Identifier: Apache-2.0
//
// Inviwo's DatVolumeReader and Voreen's DatVolumeReader: "RawFile: name" or "ObjectFileName: name",
// "Resolution: x y z", "Format: UINT8", and what else they say, in any order.

#include "dat_header.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "input_file.h"
#include "pellucid/scene/error.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

using Fields = std::map<std::string, std::string>;

std::string in_small_letters(std::string text) {
  std::ranges::transform(text, text.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return text;
}

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

// Keys in small letters. Nothing of a file that is no text of this kind.
Fields read_fields(const fs::path& path, const std::string& name) {
  Fields fields;
  // A header of more is none, whatever it begins with.
  constexpr std::size_t largest = std::size_t{1} << 16;
  if (check_input_file(path) > largest) return fields;
  std::ifstream file(path, std::ios::binary);
  std::string line;
  while (std::getline(file, line)) {
    if (line.find('\0') != std::string::npos) return {};
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos || line.starts_with('#')) continue;
    const std::string key = in_small_letters(trimmed(line.substr(0, colon)));
    if (!fields.emplace(key, trimmed(line.substr(colon + 1))).second && key == "rawfile") {
      throw Error(name + ": names several files of values; save one of them as a volume");
    }
  }
  return fields;
}

std::string value_of(const Fields& fields, const std::string& key) {
  const auto found = fields.find(key);
  return found == fields.end() ? std::string() : found->second;
}

std::string file_of(const Fields& fields) {
  const std::string file = value_of(fields, "rawfile");
  return file.empty() ? value_of(fields, "objectfilename") : file;
}

std::optional<Vec3<double>> three_numbers(const Fields& fields, const std::string& key,
                                          const std::string& name) {
  const std::string text = value_of(fields, key);
  if (text.empty()) return std::nullopt;
  std::istringstream words(text);
  Vec3<double> v{};
  words >> v.x >> v.y >> v.z;
  if (words && std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z)) return v;
  throw Error(name + ": \"" + key + ": " + text + "\" are no three numbers; mend the header");
}

std::array<int, 3> dimensions_of(const Fields& fields, const std::string& name) {
  const std::optional<Vec3<double>> sides = three_numbers(fields, "resolution", name);
  if (!sides) throw Error(name + ": the header has no \"Resolution\"; mend the header");
  std::array<int, 3> dimensions{};
  for (std::size_t a = 0; a < 3; ++a) {
    const double side = (*sides)[static_cast<int>(a)];
    if (side < 1 || side > 1e9 || side != std::floor(side)) {
      throw Error(name + ": the header's resolution is " + value_of(fields, "resolution") +
                  ", where whole numbers from 1 are meant");
    }
    dimensions[a] = static_cast<int>(side);
  }
  return dimensions;
}

// "Vec2FLOAT32": two at each point.
void find_type(const Fields& fields, ReadOptions& raw, const std::string& name) {
  static constexpr std::pair<std::string_view, const char*> types[] = {
      {"uchar", "u8"},   {"uint8", "u8"},    {"char", "i8"},    {"int8", "i8"},
      {"ushort", "u16"}, {"uint16", "u16"},  {"short", "i16"},  {"int16", "i16"},
      {"uint", "u32"},   {"uint32", "u32"},  {"int", "i32"},    {"int32", "i32"},
      {"float", "f32"},  {"float32", "f32"}, {"double", "f64"}, {"float64", "f64"}};
  const std::string format = value_of(fields, "format");
  std::string word = in_small_letters(format);
  if (word.starts_with("vec") && word.size() > 4 && word[3] >= '2' && word[3] <= '4') {
    raw.components = word[3] - '0';
    word.erase(0, 4);
  }
  for (const auto& [known, type] : types) {
    if (word == known) raw.type = type;
  }
  if (raw.type) return;
  throw Error(name + ": values of format \"" + format + "\" are not read" +
              (word == "float16" || word == "half" ? ": half floats; convert them to FLOAT32"
               : word.ends_with("64")              ? ": convert them to 32 bits or FLOAT64"
                                                   : ""));
}

void place(const Fields& fields, const std::string& name, Volume::Description& description) {
  GridPlacement& placement = description.placement;
  if (const auto thickness = three_numbers(fields, "slicethickness", name)) {
    placement.spacing = *thickness;
  }
  std::array<std::optional<Vec3<double>>, 3> basis;
  for (std::size_t a = 0; a < 3; ++a) {
    basis[a] = three_numbers(fields, "basisvector" + std::to_string(a + 1), name);
    if (!basis[a]) return;
  }
  description.centering = Centering::cell;
  Vec3<double> all{0, 0, 0}, half_step{0, 0, 0};
  for (std::size_t a = 0; a < 3; ++a) {
    const int i = static_cast<int>(a);
    const double size = length(*basis[a]);
    if (!(size > 0)) throw Error(name + ": a basis vector has no length; mend the header");
    placement.direction.column[i] = *basis[a] * (1 / size);
    placement.spacing[i] = size / description.dimensions[a];
    all = all + *basis[a];
    half_step = half_step + *basis[a] * (0.5 / description.dimensions[a]);
  }
  // Without an offset the volume's middle is at the origin.
  placement.origin = three_numbers(fields, "offset", name).value_or(all * -0.5) + half_step;
}

}  // namespace

bool is_dat_header(const fs::path& path) {
  const Fields fields = read_fields(path, path.string());
  return !file_of(fields).empty() && fields.contains("resolution");
}

VolumeFile open_dat(const fs::path& path, const ReadOptions& options) {
  const std::string name = path.string();
  refuse_raw_options(options, name);
  const Fields fields = read_fields(path, name);
  ReadOptions raw;
  raw.dimensions = dimensions_of(fields, name);
  find_type(fields, raw, name);
  raw.big_endian = in_small_letters(value_of(fields, "byteorder")) == "bigendian";
  VolumeFile file = open_raw(file_source(path.parent_path() / file_of(fields)), raw);
  file.description.name = name;
  place(fields, name, file.description);
  apply_overrides(options, file.description);
  return file;
}

}  // namespace pellucid
