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
#include "inviwo_values.h"
#include "pellucid/scene/error.h"
#include "scene_json_document.h"
#include "text.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

using Fields = std::map<std::string, std::string>;

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
    const std::string_view text = line;
    const std::string key = in_small_letters(trimmed(text.substr(0, colon)));
    if (!fields.emplace(key, trimmed(text.substr(colon + 1))).second && key == "rawfile") {
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
  const bool is_three = words && std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  if (std::string more; is_three && !(words >> more)) return v;
  throw Error(name + ": \"" + key + ": " + text + "\" are no three numbers; mend the header");
}

std::array<int, 3> dimensions_of(const Fields& fields, const std::string& name) {
  const std::optional<Vec3<double>> sides = three_numbers(fields, "resolution", name);
  if (!sides) throw Error(name + ": the header has no \"Resolution\"; mend the header");
  return {inviwo_side(sides->x, name), inviwo_side(sides->y, name), inviwo_side(sides->z, name)};
}

bool is_big_endian(const Fields& fields, const std::string& name) {
  const std::string text = value_of(fields, "byteorder"), order = in_small_letters(text);
  if (order == "bigendian" || order == "big") return true;
  if (order.empty() || order == "littleendian" || order == "little") return false;
  throw Error(name + ": \"ByteOrder: " + scene_json::printable(text) +
              "\" is neither LittleEndian nor BigEndian; mend the header");
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
  InviwoHeader header;
  header.values = path.parent_path() / file_of(fields);
  header.dimensions = dimensions_of(fields, name);
  header.format = value_of(fields, "format");
  header.big_endian = is_big_endian(fields, name);
  header.spacing = three_numbers(fields, "slicethickness", name);
  std::array<std::optional<Vec3<double>>, 3> basis;
  for (std::size_t a = 0; a < 3; ++a) {
    basis[a] = three_numbers(fields, "basisvector" + std::to_string(a + 1), name);
  }
  if (basis[0] && basis[1] && basis[2]) header.basis = {*basis[0], *basis[1], *basis[2]};
  header.offset = three_numbers(fields, "offset", name);
  return open_inviwo_values(header, name, options);
}

}  // namespace pellucid
