// SPDX-License-Identifier: Apache-2.0
//
// Inviwo's DatVolumeSequenceReader and Voreen's DatVolumeReader: "RawFile: name" or
// "ObjectFileName: name", "Resolution: x y z", "Format: UINT8", and what else they say, in any
// order.

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "files/input_file.h"
#include "inviwo_values.h"
#include "pellucid/scene/error.h"
#include "text/latin_text.h"
#include "text/printable.h"
#include "text/text.h"
#include "volumes/components.h"
#include "volumes/volume_format.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

struct Field {
  std::string key, value;  // as written
  bool is_repeated = false;
};
using Fields = std::map<std::string, Field>;

// Keys in small letters. Nothing of a file that is no text of this kind.
Fields read_fields(const fs::path& path, const std::string& name) {
  Fields fields;
  // A header of more is none, whatever it begins with.
  constexpr std::size_t largest = std::size_t{1} << 16;
  if (check_input_file(path) > largest) return fields;
  std::ifstream file(path, std::ios::binary);
  std::string line;
  for (bool is_first = true; std::getline(file, line); is_first = false) {
    if (is_first) drop_mark(line);
    if (line.find('\0') != std::string::npos) return {};
    // As Inviwo reads it: the rest of a line behind # is a comment, and so is one that begins with
    // /.
    const std::string_view text = trimmed(std::string_view(line).substr(0, line.find('#')));
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos || text.starts_with('/')) continue;
    const std::string_view word = trimmed(text.substr(0, colon));
    const std::string key = in_small_letters(word);
    Field field{std::string(word), std::string(trimmed(text.substr(colon + 1)))};
    const auto [place, is_new] = fields.try_emplace(key, field);
    if (is_new) continue;
    place->second.is_repeated = place->second.is_repeated || place->second.value != field.value;
    if (key == "rawfile") {
      throw Error(name + ": names several files of values; save one of them as a volume");
    }
  }
  return fields;
}

std::string value_of(const Fields& fields, const std::string& key) {
  const auto found = fields.find(key);
  return found == fields.end() ? std::string() : found->second.value;
}

std::string file_of(const Fields& fields) {
  const std::string file = value_of(fields, "rawfile");
  return file.empty() ? value_of(fields, "objectfilename") : file;
}

template <std::size_t count>
std::optional<std::array<double, count>> numbers(const Fields& fields, const std::string& key,
                                                 const std::string& name) {
  const std::string text = value_of(fields, key);
  if (text.empty()) return std::nullopt;
  std::istringstream words(text);
  std::array<double, count> list{};
  bool are_numbers = true;
  for (double& number : list) are_numbers = are_numbers && words >> number && std::isfinite(number);
  if (std::string more; are_numbers && !(words >> more)) return list;
  constexpr const char* counts[] = {"no", "no", "no two", "no three", "no four"};
  throw Error(name + ": \"" + fields.at(key).key + ": " + printable(text) + "\" are " +
              counts[count] + " numbers; mend the header");
}

std::optional<Vec3<double>> three_numbers(const Fields& fields, const std::string& key,
                                          const std::string& name) {
  const auto list = numbers<3>(fields, key, name);
  if (!list) return std::nullopt;
  return Vec3<double>{(*list)[0], (*list)[1], (*list)[2]};
}

std::array<int, 3> dimensions_of(const Fields& fields, const std::string& name) {
  for (const char* const key : {"resolution", "dimensions", "dimension"}) {
    const std::optional<Vec3<double>> sides = three_numbers(fields, key, name);
    if (!sides) continue;
    return {inviwo_side(sides->x, name), inviwo_side(sides->y, name), inviwo_side(sides->z, name)};
  }
  throw Error(name + ": the header has no \"Resolution\"; mend the header");
}

bool has_dimensions(const Fields& fields) {
  return fields.contains("resolution") || fields.contains("dimensions") ||
         fields.contains("dimension");
}

/// Returns a whole number from `least` on; nothing where the key is missing.
std::optional<std::uint64_t> whole_number(const Fields& fields, const std::string& key,
                                          std::uint64_t least, const std::string& name) {
  const std::string text = value_of(fields, key);
  if (text.empty()) return std::nullopt;
  std::uint64_t number = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error == std::errc{} && stop == end && number >= least) return number;
  throw Error(name + ": \"" + fields.at(key).key + ": " + printable(text) +
              "\" is no whole number from " + std::to_string(least) + "; mend the header");
}

/// Reads a basis. Inviwo writes matrices row by row: the vectors are rows, and what they span are
/// columns.
void read_basis(const Fields& fields, const std::string& name, InviwoHeader& header) {
  std::array<Vec3<double>, 3> columns{};
  int count = 0;
  for (int row = 0; row < 3; ++row) {
    const auto vector = three_numbers(fields, "basisvector" + std::to_string(row + 1), name);
    if (!vector) continue;
    ++count;
    for (int a = 0; a < 3; ++a) columns[static_cast<std::size_t>(a)][row] = (*vector)[a];
  }
  if (count == 0) return;
  if (count < 3)
    throw Error(name + ": has not all of BasisVector1 to BasisVector3; mend the header");
  header.basis = columns;
}

void read_world(const Fields& fields, const std::string& name, InviwoHeader& header) {
  std::array<Vec3<double>, 4> columns{Vec3<double>{1, 0, 0}, Vec3<double>{0, 1, 0},
                                      Vec3<double>{0, 0, 1}, Vec3<double>{0, 0, 0}};
  bool is_given = false;
  for (int row = 0; row < 4; ++row) {
    const auto vector = numbers<4>(fields, "worldvector" + std::to_string(row + 1), name);
    if (!vector) continue;
    is_given = true;
    if (row == 3) {
      if (*vector == std::array<double, 4>{0, 0, 0, 1}) continue;
      throw Error(name + ": its WorldVectors are no affine map, whose WorldVector4 is 0 0 0 1");
    }
    for (std::size_t a = 0; a < 4; ++a) columns[a][row] = (*vector)[a];
  }
  if (is_given) header.world = columns;
}

/// Returns the keys that are neither read nor known to leave the picture as it is.
std::vector<std::string> ignored_keys(const Fields& fields) {
  constexpr std::array known = std::to_array<std::string_view>(
      {"rawfile", "objectfilename", "datfile", "resolution", "dimensions", "dimension", "format",
       "byteorder", "byteoffset", "sequences", "slicethickness", "spacing", "basisvector1",
       "basisvector2", "basisvector3", "offset", "worldvector1", "worldvector2", "worldvector3",
       "worldvector4", "datarange", "valuerange", "unit", "valueunit",
       // Names and the like.
       "taggedfilename", "nbrtags", "objectmodel", "objecttype", "modality", "valuename",
       "axis1name", "axis2name", "axis3name", "axis1unit", "axis2unit", "axis3unit", "wrapping"});
  std::vector<std::string> keys;
  for (const auto& [key, field] : fields) {
    if (field.is_repeated) keys.push_back(field.key + " (more than once)");
    if (std::ranges::find(known, key) != known.end() || field.value.empty()) continue;
    const std::string value = in_small_letters(field.value);
    // What is so without the key.
    if ((key == "swizzlemask" && value == "rgba") ||
        (key == "interpolation" && value == "linear") ||
        (key == "gridtype" && (value == "uniform" || value == "equidistant"))) {
      continue;
    }
    keys.push_back(field.key);
  }
  return keys;
}

bool is_big_endian(const Fields& fields, const std::string& name) {
  const std::string text = value_of(fields, "byteorder"), order = in_small_letters(text);
  if (order == "bigendian" || order == "big") return true;
  if (order.empty() || order == "littleendian" || order == "little") return false;
  throw Error(name + ": \"ByteOrder: " + printable(text) +
              "\" is neither LittleEndian nor BigEndian; mend the header");
}

/// Returns whether a file is a header of Inviwo or Voreen: lines "Key: value", one of which names
/// the file of values.
bool is_dat_header(const fs::path& path) {
  const Fields fields = read_fields(path, path.string());
  return (!file_of(fields).empty() && has_dimensions(fields)) || fields.contains("datfile");
}

/// Opens such a header (.dat) and its file of values. Of Voreen the spacing (SliceThickness), of
/// Inviwo basis vectors and offset, which span the cells that the values are the centres of. Throws
/// Error.
VolumeFile open_dat(const fs::path& path, const ReadOptions& options) {
  const std::string name = path.string();
  refuse_raw_options(options, name);
  const Fields fields = read_fields(path, name);
  if (fields.contains("datfile")) {
    throw Error(name + ": lists headers of steps (DatFile); give one of them, such as " +
                printable(value_of(fields, "datfile")));
  }
  InviwoHeader header;
  header.values = path.parent_path() / file_of(fields);
  header.dimensions = dimensions_of(fields, name);
  header.format = value_of(fields, "format");
  header.big_endian = is_big_endian(fields, name);
  header.skip_bytes = whole_number(fields, "byteoffset", 0, name).value_or(0);
  const std::uint64_t steps = whole_number(fields, "sequences", 1, name).value_or(1);
  if (steps > std::numeric_limits<std::int32_t>::max()) {
    throw Error(name + ": says " + std::to_string(steps) + " Sequences; mend the header");
  }
  header.steps = static_cast<int>(steps);
  header.spacing = three_numbers(fields, "slicethickness", name);
  if (const auto spacing = three_numbers(fields, "spacing", name)) {
    header.spacing = spacing;
    header.is_of_inviwo = true;
  }
  read_basis(fields, name, header);
  header.offset = three_numbers(fields, "offset", name);
  read_world(fields, name, header);
  header.data_range = numbers<2>(fields, "datarange", name);
  header.value_range = numbers<2>(fields, "valuerange", name);
  if (in_small_letters(header.format) == "ushort_12" && !header.data_range) {
    header.data_range = {0, 4095};
  }
  header.unit = value_of(fields, fields.contains("unit") ? "unit" : "valueunit");
  header.ignored_keys = ignored_keys(fields);
  return open_inviwo_values(header, name, options);
}

}  // namespace

extern const VolumeFormat dat_format{
    .name = "Inviwo or Voreen, .dat", .takes_unknown_name = is_dat_header, .open = open_dat};

}  // namespace pellucid
