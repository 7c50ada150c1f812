// SPDX-License-Identifier: Apache-2.0
//
// https://docs.xarray.dev/en/stable/internals/zarr-encoding-spec.html
#include "zarr_variable.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>

#include "axes/positions_beside.h"
#include "pellucid/scene/error.h"
#include "text/text.h"
#include "zarr_values.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

/// Returns the number that a text of JSON stands for: "NaN", "-Infinity".
std::optional<double> number_of(std::string_view text) {
  if (text == "NaN" || text == "nan") return std::numeric_limits<double>::quiet_NaN();
  if (text == "Infinity") return std::numeric_limits<double>::infinity();
  if (text == "-Infinity") return -std::numeric_limits<double>::infinity();
  return std::nullopt;
}

/// Returns the double whose bytes, little-endian, are written in base 64, as xarray does in version
/// 3 of the format.
std::optional<double> packed_double(std::string_view text) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  if (text.size() != 12 || text.back() != '=') return std::nullopt;
  std::array<std::uint8_t, 9> bytes{};
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 12; ++i) {
    const std::size_t digit = i == 11 ? 0 : digits.find(text[i]);
    if (digit == std::string_view::npos) return std::nullopt;
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    if (i % 4 != 3) continue;
    for (std::size_t b = 0; b < 3; ++b) {
      bytes[i / 4 * 3 + b] = static_cast<std::uint8_t>(bits >> (16 - 8 * b));
    }
    bits = 0;
  }
  std::uint64_t number = 0;
  for (std::size_t b = 8; b-- > 0;) number = number << 8 | bytes[b];
  return std::bit_cast<double>(number);
}

void add_number(const nlohmann::json& value, VariableAttribute& attribute) {
  if (value.is_number()) attribute.numbers.push_back(value.get<double>());
  if (value.is_boolean()) attribute.numbers.push_back(value.get<bool>() ? 1 : 0);
  if (value.is_string()) {
    if (const auto number = number_of(value.get_ref<const std::string&>())) {
      attribute.numbers.push_back(*number);
    }
  }
  attribute.is_real = attribute.is_real || value.is_number_float() || value.is_string();
}

/// Returns an attribute; without numbers and text where it is neither, and nothing for null.
std::optional<VariableAttribute> attribute_of(const nlohmann::json& value) {
  VariableAttribute attribute;
  if (value.is_array()) {
    if (value.size() > max_attribute_numbers) return VariableAttribute{};
    for (const nlohmann::json& element : value) add_number(element, attribute);
    if (attribute.numbers.size() != value.size()) return VariableAttribute{};
    return attribute;
  }
  if (value.is_null()) return std::nullopt;
  if (value.is_object()) return attribute;
  add_number(value, attribute);
  if (!attribute.numbers.empty()) return attribute;
  attribute.is_real = false;
  attribute.is_text = true;
  attribute.text = value.get<std::string>().substr(0, longest_attribute_text);
  return attribute;
}

template <class Number>
double fill_as(const ZarrArray& array) {
  Number number{};
  std::memcpy(&number, array.fill.data(), sizeof number);
  return static_cast<double>(number);
}

double fill_number(const ZarrArray& array) {
  const std::string& type = array.type.name;
  if (type == "u8" || type == "b1") return fill_as<std::uint8_t>(array);
  if (type == "i8") return fill_as<std::int8_t>(array);
  if (type == "u16") return fill_as<std::uint16_t>(array);
  if (type == "i16") return fill_as<std::int16_t>(array);
  if (type == "u32") return fill_as<std::uint32_t>(array);
  if (type == "i32") return fill_as<std::int32_t>(array);
  if (type == "u64") return fill_as<std::uint64_t>(array);
  if (type == "i64") return fill_as<std::int64_t>(array);
  return type == "f64" ? fill_as<double>(array) : fill_as<float>(array);
}

/// Whole numbers without a sign that a store has with one (_Unsigned), and the other way round.
void apply_unsigned(const VariableAttributes& attributes, ZarrArray& array) {
  const std::string text = in_small_letters(text_of(attributes, "_Unsigned"));
  // xarray writes truth values as bytes that say so.
  const bool is_truth = array.type.name == "i8" && text_of(attributes, "dtype") == "bool";
  if ((text == "true" || is_truth) && array.type.name[0] == 'i') array.type.name[0] = 'u';
  if (text == "false" && array.type.name[0] == 'u') array.type.name[0] = 'i';
}

/// Returns the coordinate of an axis: the array of its name, else one that `coordinates` names and
/// that has this axis alone.
std::optional<fs::path> coordinate_of(const ZarrVariable& variable, std::size_t axis) {
  const std::string& name = variable.array.dimension_names[axis];
  std::vector<std::string> names = words_of(variable.attributes, "coordinates");
  names.insert(names.begin(), name);
  for (const std::string& each : names) {
    if (each.empty()) continue;
    const fs::path folder = variable.folder.parent_path() / fs::path(each).filename();
    const auto node = read_zarr_node(folder);
    if (!node || !node->is_array) continue;
    const ZarrArray line = zarr_array(*node);
    if (line.shape != std::vector<std::int64_t>{variable.array.shape[axis]}) continue;
    // Stores without names of axes for their positions go by the name of the array.
    if (each == name || line.dimension_names == std::vector{name}) return folder;
  }
  return std::nullopt;
}

/// Returns where a variable is, with all of the folders that it is in.
fs::path place_of(const fs::path& folder) {
  const fs::path place = fs::absolute(folder).lexically_normal();
  return place.has_filename() ? place : place.parent_path();
}

/// Returns the arrays in a variable's group but the coordinates of its axes.
std::vector<ArrayBeside> arrays_beside(const ZarrVariable& variable) {
  std::vector<ArrayBeside> arrays;
  const fs::path own = place_of(variable.folder);
  const auto group = read_zarr_node(own.parent_path());
  if (!group || group->is_array) return arrays;
  std::vector<fs::path> known{own};
  for (std::size_t a = 0; a < variable.array.dimension_names.size(); ++a) {
    if (const auto coordinate = coordinate_of(variable, a)) {
      known.push_back(place_of(*coordinate));
    }
  }
  std::error_code error;
  int count = 0;
  constexpr int max_arrays = 4096;
  for (fs::directory_iterator entry(own.parent_path(), error), end; !error && entry != end;
       entry.increment(error)) {
    const fs::path folder = entry->path().lexically_normal();
    if (++count > max_arrays) break;
    if (!entry->is_directory(error) || std::ranges::find(known, folder) != known.end()) continue;
    try {
      const auto node = read_zarr_node(folder);
      if (node && node->is_array) {
        arrays.push_back({one_line(folder.filename().string()), zarr_array(*node).shape});
      }
    } catch (const Error&) {
      continue;  // an array that is not read
    }
  }
  std::ranges::sort(arrays, {}, &ArrayBeside::name);
  return arrays;
}

}  // namespace

VariableAttributes zarr_attributes(const ZarrNode& node) {
  VariableAttributes attributes;
  const nlohmann::json& all = node.attributes.value;
  if (!all.is_object()) return attributes;
  for (const auto& [name, value] : all.items()) {
    if (auto attribute = attribute_of(value)) attributes[name] = *std::move(attribute);
  }
  const auto fill = attributes.find("_FillValue");
  if (fill != attributes.end() && fill->second.is_text) {
    if (const auto number = packed_double(fill->second.text)) {
      fill->second = {false, true, {}, {*number}};
    }
  }
  return attributes;
}

ZarrVariable zarr_variable(const fs::path& folder, const std::string& name) {
  ZarrVariable variable;
  variable.folder = folder;
  const auto node = read_zarr_node(folder);
  if (!node || !node->is_array) throw Error(folder.string() + ": is no array of Zarr");
  variable.array = zarr_array(*node);
  variable.attributes = zarr_attributes(*node);
  apply_unsigned(variable.attributes, variable.array);
  ZarrArray& array = variable.array;
  const std::string type = array.type.name == "f16" ? "f32" : array.type.name;
  try {
    variable.meaning = value_meaning(variable.attributes, type, name, variable.notes);
  } catch (const Error& error) {
    throw Error(folder.string() + ": " + error.what());
  }
  // xarray keeps _FillValue as the fill value of version 2. Where that is 0, most other programs
  // mean zeros.
  const bool is_mask = node->version == 2 && !array.dimension_names.empty() && array.has_fill &&
                       array.type.name != "b1";
  if (is_mask && fill_number(array) != 0) {
    variable.meaning.missing.push_back(fill_number(array));
  }
  variable.may_hide_zeros =
      is_mask && fill_number(array) == 0 && !variable.attributes.contains("_FillValue");
  return variable;
}

std::vector<AxisText> zarr_axis_texts(const ZarrVariable& variable) {
  std::vector<AxisText> texts(variable.array.dimension_names.size());
  for (std::size_t a = 0; a < texts.size(); ++a) {
    texts[a].name = variable.array.dimension_names[a];
    const auto coordinate = coordinate_of(variable, a);
    const auto node = coordinate ? read_zarr_node(*coordinate) : std::nullopt;
    if (!node) continue;
    texts[a].coordinate = zarr_attributes(*node);
    texts[a].coordinate_name = coordinate->filename().string();
  }
  return texts;
}

AxisPositions zarr_positions(const ZarrVariable& variable, std::size_t axis) {
  const auto folder = coordinate_of(variable, axis);
  if (!folder) return {};
  const std::string name = folder->filename().string();
  const ZarrVariable line = zarr_variable(*folder, name);
  AxisPositions positions = positions_along({name, {}, line.attributes, {}});
  positions.rounding = line.array.type.bytes <= 4 ? 1.2e-7 : 2.3e-16;
  positions.numbers =
      read_zarr_line(*folder, line.array, static_cast<std::size_t>(line.array.shape[0]));
  apply_meaning(positions.numbers, line.array.type.name, line.meaning);
  return positions;
}

std::vector<std::string> zarr_notes(const ZarrVariable& variable, const std::string& name) {
  std::vector<std::string> notes = notes_on_unread(variable.attributes, name);
  std::string list;
  for (const char* attribute : {"element_size_um", "axistags", "DIMENSION_LABELS"}) {
    if (!variable.attributes.contains(attribute)) continue;
    list += (list.empty() ? "" : ", ") + std::string(attribute);
  }
  if (!list.empty()) {
    notes.push_back("\"" + name + "\" has attributes of HDF5 that are not applied (" + list + ")");
  }
  const PositionsBeside beside =
      positions_beside(arrays_beside(variable), variable.array.shape, {{}, {}, true, true});
  for (const std::string& note : beside.notes) notes.push_back("\"" + name + "\": " + note);
  fs::path group = place_of(variable.folder);
  constexpr int deepest = 8;
  for (int depth = 0; depth < deepest && group.has_parent_path(); ++depth) {
    group = group.parent_path();
    const auto node = read_zarr_node(group);
    if (!node || node->is_array) break;
    std::string note = note_on_group(zarr_attributes(*node), group.filename().string(), name);
    if (!note.empty()) notes.push_back(std::move(note));
  }
  return notes;
}

std::vector<std::string> zarr_notes(const ZarrVariable& variable, const std::string& name,
                                    const VolumeAxes& axes) {
  std::array<std::string, 3> space;
  for (std::size_t a = 0; a < 3; ++a) space[a] = variable.array.dimension_names[axes.space[a]];
  const FindVariable find = [&](const std::string& other) -> std::optional<NamedVariable> {
    const auto node = read_zarr_node(variable.folder.parent_path() / fs::path(other).filename());
    if (!node || !node->is_array) return std::nullopt;
    return NamedVariable{zarr_attributes(*node), zarr_array(*node).dimension_names};
  };
  return variable_notes(name, variable.attributes, space, find);
}

}  // namespace pellucid
