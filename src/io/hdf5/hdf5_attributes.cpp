// SPDX-License-Identifier: Apache-2.0
//
// Dimension scales: https://support.hdfgroup.org/documentation/hdf5/latest/_h5_d_s__u_g.html
#include "hdf5_attributes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string_view>
#include <utility>

#include "axes/value_meaning.h"
#include "hdf5_parts.h"
#include "text/text.h"

namespace pellucid {

namespace {

std::size_t entries_of(hid_t attribute) {
  const Id space(H5Aget_space(attribute), H5Sclose, "an attribute");
  const hssize_t count = H5Sget_simple_extent_npoints(space.get());
  return count < 0 ? 0 : static_cast<std::size_t>(count);
}

/// Returns the texts of an attribute, of a fixed or of any length.
std::vector<std::string> texts_at(hid_t attribute) {
  const Id type(H5Aget_type(attribute), H5Tclose, "an attribute");
  const std::size_t count = entries_of(attribute);
  std::vector<std::string> texts;
  if (H5Tget_class(type.get()) != H5T_STRING || count == 0 || count > max_attribute_numbers) {
    return texts;
  }
  const Id space(H5Aget_space(attribute), H5Sclose, "an attribute");
  const Id memory(H5Tcopy(type.get()), H5Tclose, "an attribute");
  if (H5Tis_variable_str(type.get()) > 0) {
    std::vector<char*> pointers(count, nullptr);
    if (H5Aread(attribute, memory.get(), pointers.data()) < 0) return texts;
    for (const char* text : pointers) {
      texts.push_back(text == nullptr ? std::string()
                                      : std::string(text).substr(0, longest_attribute_text));
    }
    H5Dvlen_reclaim(memory.get(), space.get(), H5P_DEFAULT, pointers.data());
    return texts;
  }
  const std::size_t size = H5Tget_size(type.get());
  if (size == 0 || size * count > longest_attribute_text) return texts;
  std::string all(size * count, '\0');
  if (H5Aread(attribute, memory.get(), all.data()) < 0) return texts;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string text = all.substr(i * size, size);
    texts.push_back(text.substr(0, text.find('\0')));
  }
  return texts;
}

/// Reads an attribute that is text or plain numbers; nothing where it is neither.
std::optional<VariableAttribute> read_attribute(hid_t dataset, const char* name) {
  const Id attribute(H5Aopen(dataset, name, H5P_DEFAULT), H5Aclose, "an attribute");
  const hid_t id = attribute.get();
  const Id type(H5Aget_type(id), H5Tclose, "an attribute");
  VariableAttribute read;
  const H5T_class_t kind = H5Tget_class(type.get());
  const std::size_t count = entries_of(id);
  if (kind == H5T_STRING) {
    std::vector<std::string> texts = texts_at(id);
    read.is_text = true;
    if (!texts.empty()) read.text = std::move(texts.front());
    return read;
  }
  if ((kind != H5T_INTEGER && kind != H5T_FLOAT) || count > max_attribute_numbers) {
    return std::nullopt;
  }
  read.is_real = kind == H5T_FLOAT;
  read.numbers.resize(count);
  if (count > 0 && H5Aread(id, H5T_NATIVE_DOUBLE, read.numbers.data()) < 0) return std::nullopt;
  return read;
}

/// Takes a name for HDF5, through which no exception may pass.
herr_t take_name(hid_t, const char* name, const H5A_info_t*, void* to) noexcept {
  static_cast<std::vector<std::string>*>(to)->emplace_back(name);
  return 0;
}

/// An axis of ilastik's and vigra's tags.
struct AxisTag {
  std::string key;
  double resolution = 0;
};

/// Returns what stands behind a key of a flat object of JSON, without the blanks in front.
std::string_view behind(std::string_view object, std::string_view key) {
  const std::size_t at = object.find("\"" + std::string(key) + "\"");
  if (at == std::string_view::npos) return {};
  const std::size_t begin = object.find_first_not_of(" \t\r\n:", at + key.size() + 2);
  return begin == std::string_view::npos ? std::string_view() : object.substr(begin);
}

/// Reads {"axes": [{"key": "z", "typeFlags": 2, "resolution": 0, "description": ""}, …]}
std::vector<AxisTag> axis_tags(std::string_view json) {
  std::vector<AxisTag> tags;
  std::size_t begin = json.find('{');
  begin = begin == std::string_view::npos ? begin : json.find('{', begin + 1);
  while (begin != std::string_view::npos && tags.size() < H5S_MAX_RANK) {
    const std::size_t end = json.find('}', begin);
    const std::string_view object = json.substr(begin, end - begin);
    const std::string_view key = behind(object, "key");
    AxisTag tag;
    if (key.starts_with('"')) tag.key = key.substr(1, key.find('"', 1) - 1).substr(0, 40);
    tag.resolution = std::strtod(std::string(behind(object, "resolution")).c_str(), nullptr);
    tags.push_back(std::move(tag));
    begin = end == std::string_view::npos ? end : json.find('{', end);
  }
  return tags;
}

std::string last_name_of(hid_t object) {
  std::array<char, 1024> name{};
  if (H5Iget_name(object, name.data(), name.size() - 1) <= 0) return {};
  const std::string path = name.data();
  return path.substr(path.rfind('/') + 1);
}

/// Reads what one dimension scale says of the axis that it belongs to.
void read_scale(hid_t scale, std::int64_t side, AxisText& text, AxisPositions& positions) {
  if (text.name.empty()) text.name = last_name_of(scale);
  text.coordinate = hdf5_attributes(scale);
  const std::string title = text_of(text.coordinate, "NAME");
  positions = positions_along(text);
  if (title.starts_with("This is a netCDF dimension but not a netCDF variable")) return;
  const Id space(H5Dget_space(scale), H5Sclose, "a dimension scale");
  const Id type(H5Dget_type(scale), H5Tclose, "a dimension scale");
  const auto number = type_of(type.get());
  const bool is_line = H5Sget_simple_extent_ndims(space.get()) == 1 &&
                       H5Sget_simple_extent_npoints(space.get()) == side;
  if (!is_line || !number) return;
  check_kind(scale, type.get());
  positions.numbers.resize(static_cast<std::size_t>(side));
  if (H5Dread(scale, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, positions.numbers.data()) <
      0) {
    throw unreadable_values(scale, text.name);
  }
  positions.rounding = *number == "f32" ? 0x1p-24 : 0x1p-53;
  const std::string meant = hdf5_meant_type(*number, text.coordinate);
  const double span = std::exp2(8 * static_cast<double>(H5Tget_size(memory_type(meant))));
  for (double& position : positions.numbers) {
    if (meant[0] == 'u' && position < 0) position += span;
    if (meant[0] == 'i' && position >= span / 2) position -= span;
  }
  std::vector<std::string> notes;
  apply_meaning(positions.numbers, meant, value_meaning(text.coordinate, meant, text.name, notes));
}

/// Visits the first dimension scale of each axis.
void read_scales(hid_t dataset, const std::vector<std::int64_t>& shape, Hdf5Axes& axes) {
  if (H5Aexists(dataset, "DIMENSION_LIST") <= 0) return;
  const Id attribute(H5Aopen(dataset, "DIMENSION_LIST", H5P_DEFAULT), H5Aclose, "an attribute");
  const Id type(H5Aget_type(attribute.get()), H5Tclose, "an attribute");
  if (H5Tget_class(type.get()) != H5T_VLEN || entries_of(attribute.get()) != shape.size()) return;
  const Id space(H5Aget_space(attribute.get()), H5Sclose, "an attribute");
  const Id memory(H5Tvlen_create(H5T_STD_REF_OBJ), H5Tclose, "an attribute");
  std::vector<hvl_t> lists(shape.size());
  if (H5Aread(attribute.get(), memory.get(), lists.data()) < 0) return;
  for (std::size_t a = 0; a < lists.size(); ++a) {
    if (lists[a].len == 0) continue;
    const hid_t id = H5Rdereference2(dataset, H5P_DEFAULT, H5R_OBJECT, lists[a].p);
    if (id < 0) continue;
    const Id scale(id, H5Oclose, "a dimension scale");
    if (H5Iget_type(id) == H5I_DATASET) {
      read_scale(id, shape[a], axes.texts[a], axes.positions[a]);
    }
  }
  H5Dvlen_reclaim(memory.get(), space.get(), H5P_DEFAULT, lists.data());
}

std::vector<double> even_positions(std::int64_t side, double distance) {
  std::vector<double> numbers(static_cast<std::size_t>(side));
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<double>(i) * distance;
  return numbers;
}

bool is_distance(double number) {
  return std::isfinite(number) && number > 0;
}

/// Takes the keys of axis tags for the axes' names, and their resolutions for distances.
void read_tags(const VariableAttributes& attributes, const std::vector<std::int64_t>& shape,
               const std::string& name, Hdf5Axes& axes) {
  const std::string json = text_of(attributes, "axistags");
  if (json.empty()) return;
  const std::vector<AxisTag> tags = axis_tags(json);
  if (tags.size() != shape.size()) {
    axes.notes.push_back("the axistags of \"" + name + "\" are of " + std::to_string(tags.size()) +
                         " axes and are not applied");
    return;
  }
  for (std::size_t a = 0; a < tags.size(); ++a) {
    axes.texts[a].name = tags[a].key;
    if (is_distance(tags[a].resolution)) {
      axes.positions[a].numbers = even_positions(shape[a], tags[a].resolution);
    }
  }
}

/// Takes sizes of voxels in micrometers, as ilastik, PlantSeg and ImageJ write them, in the order
/// of the dataset's last three axes.
void read_element_size(const VariableAttributes& attributes, const std::vector<std::int64_t>& shape,
                       const std::string& name, Hdf5Axes& axes) {
  const auto found = attributes.find("element_size_um");
  if (found == attributes.end() || shape.size() < 3) return;
  if (found->second.numbers.size() != 3 ||
      !std::ranges::all_of(found->second.numbers, is_distance)) {
    axes.notes.push_back("the element_size_um of \"" + name +
                         "\" is not three distances above 0, those of z, y and x, and is not "
                         "applied");
    return;
  }
  std::vector<std::size_t> space;
  for (std::size_t a = 0; a < shape.size(); ++a) {
    const AxisRole role = axis_evidence(axes.texts[a]).role;
    const bool is_other = role == AxisRole::time || role == AxisRole::channel;
    if (!is_other) space.push_back(a);
  }
  if (space.size() < 3) return;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t axis = space[space.size() - 3 + i];
    if (!axes.positions[axis].numbers.empty()) continue;
    axes.positions[axis].numbers = even_positions(shape[axis], found->second.numbers[i]);
    axes.positions[axis].units = "um";
  }
}

/// Returns how many chunks of how many were written; nothing where the dataset has none.
std::optional<std::pair<hsize_t, hsize_t>> written_chunks(hid_t dataset, hid_t how,
                                                          const std::vector<std::int64_t>& shape) {
  std::vector<hsize_t> chunk(shape.size());
  const int rank = static_cast<int>(shape.size());
  if (H5Pget_layout(how) != H5D_CHUNKED || H5Pget_chunk(how, rank, chunk.data()) != rank) {
    return std::nullopt;
  }
  hsize_t total = 1, written = 0;
  for (std::size_t a = 0; a < shape.size(); ++a) {
    if (chunk[a] == 0) return std::nullopt;
    total *= (static_cast<hsize_t>(shape[a]) - 1) / chunk[a] + 1;
  }
  const Id space(H5Dget_space(dataset), H5Sclose, "the axes of a dataset");
  if (H5Dget_num_chunks(dataset, space.get(), &written) < 0) return std::nullopt;
  return std::pair{written, total};
}

/// Takes a name for HDF5, through which no exception may pass. Links to elsewhere are not followed.
herr_t take_link_name(hid_t, const char* name, const H5L_info_t* about, void* to) noexcept {
  auto& names = *static_cast<std::vector<std::string>*>(to);
  constexpr std::size_t max_names = 4096;
  if (about->type == H5L_TYPE_HARD && names.size() < max_names) names.emplace_back(name);
  return 0;
}

/// Returns the sides of a dataset; nothing where it has none, or more than eight.
std::optional<std::vector<std::int64_t>> sides_of(hid_t dataset) {
  const Id space(H5Dget_space(dataset), H5Sclose, "the axes of a dataset");
  constexpr int max_axes = 8;
  const int rank = H5Sget_simple_extent_ndims(space.get());
  if (rank < 0 || rank > max_axes || H5Sget_simple_extent_type(space.get()) == H5S_NULL) {
    return std::nullopt;
  }
  std::vector<hsize_t> sides(static_cast<std::size_t>(rank));
  H5Sget_simple_extent_dims(space.get(), sides.data(), nullptr);
  std::vector<std::int64_t> shape;
  for (const hsize_t side : sides) {
    if (side > static_cast<hsize_t>(std::numeric_limits<int>::max())) return std::nullopt;
    shape.push_back(static_cast<std::int64_t>(side));
  }
  return shape;
}

/// Reads a small dataset of numbers; it stays without them where it has none.
void read_numbers(hid_t dataset, ArrayBeside& array) {
  const Id type(H5Dget_type(dataset), H5Tclose, "the type of a dataset");
  if (!type_of(type.get())) return;
  try {
    check_kind(dataset, type.get());
  } catch (const Error&) {
    return;
  }
  std::size_t count = 1;
  for (const std::int64_t side : array.shape) count *= static_cast<std::size_t>(side);
  std::vector<double> numbers(count);
  if (count == 0 ||
      H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()) < 0) {
    return;
  }
  array.numbers = std::move(numbers);
  const VariableAttributes attributes = hdf5_attributes(dataset);
  for (const char* key : {"units", "unit"}) {
    if (array.units.empty()) array.units = text_of(attributes, key).substr(0, 40);
  }
}

/// Adds the datasets of one group. Those of arrays of several sides are of none of them alone.
void add_arrays_of(hid_t group, const std::string& own_name, const std::vector<std::int64_t>& shape,
                   const Hdf5Axes& axes, std::vector<ArrayBeside>& arrays) {
  std::vector<std::string> names;
  H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, take_link_name, &names);
  const std::size_t first = arrays.size();
  bool has_others = false;
  for (const std::string& name : names) {
    const bool is_scale =
        std::ranges::any_of(axes.texts, [&](const AxisText& text) { return text.name == name; });
    const bool is_known =
        std::ranges::any_of(arrays, [&](const ArrayBeside& array) { return array.name == name; });
    if (name == own_name || is_scale || is_known) continue;
    const hid_t opened = H5Oopen(group, name.c_str(), H5P_DEFAULT);
    if (opened < 0) continue;
    const Id object(opened, H5Oclose, "an object");
    if (H5Iget_type(opened) != H5I_DATASET) continue;
    const auto sides = sides_of(opened);
    if (!sides) continue;
    has_others = has_others || (sides->size() > 2 && *sides != shape);
    ArrayBeside array{name, *sides};
    if (may_say_positions(array, shape)) {
      read_numbers(opened, array);
      arrays.push_back(std::move(array));
    } else if (sides->size() > 1 && sides->size() <= shape.size()) {
      arrays.push_back(std::move(array));
    }
  }
  for (std::size_t i = first; i < arrays.size(); ++i) arrays[i].is_of_several = has_others;
}

}  // namespace

std::vector<ArrayBeside> hdf5_arrays_beside(hid_t dataset, const std::string& name,
                                            const std::vector<std::int64_t>& shape,
                                            const Hdf5Axes& axes) {
  std::vector<ArrayBeside> arrays;
  const Id file(H5Iget_file_id(dataset), H5Fclose, "the file");
  for (std::size_t end = name.rfind('/'); end != std::string::npos;
       end = end == 0 ? std::string::npos : name.rfind('/', end - 1)) {
    const std::string path = end == 0 ? "/" : name.substr(0, end);
    const hid_t opened = H5Gopen2(file.get(), path.c_str(), H5P_DEFAULT);
    if (opened < 0) continue;
    const Id group(opened, H5Gclose, "a group");
    const std::size_t begin = end + 1;
    add_arrays_of(group.get(), name.substr(begin, name.find('/', begin) - begin), shape, axes,
                  arrays);
  }
  return arrays;
}

VariableAttributes hdf5_attributes(hid_t dataset) {
  std::vector<std::string> names;
  H5Aiterate2(dataset, H5_INDEX_NAME, H5_ITER_INC, nullptr, take_name, &names);
  VariableAttributes attributes;
  for (const std::string& name : names) {
    if (auto read = read_attribute(dataset, name.c_str())) attributes[name] = *std::move(read);
  }
  return attributes;
}

std::vector<std::string> hdf5_texts(hid_t object, const std::string& name) {
  if (H5Aexists(object, name.c_str()) <= 0) return {};
  const Id attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, "an attribute");
  std::vector<std::string> texts = texts_at(attribute.get());
  if (!texts.empty()) return texts;
  const auto read = read_attribute(object, name.c_str());
  if (!read || read->numbers.size() != 1) return {};
  std::array<char, 32> number{};
  std::snprintf(number.data(), number.size(), "%.17g", read->numbers.front());
  return {number.data()};
}

std::string hdf5_meant_type(std::string type, const VariableAttributes& attributes) {
  const std::string text = in_small_letters(text_of(attributes, "_Unsigned"));
  const bool is_wide = type.ends_with("64");
  // xarray writes truth values as bytes that say so.
  const bool is_truth = type == "i8" && text_of(attributes, "dtype") == "bool";
  if ((text == "true" || is_truth) && type[0] == 'i' && !is_wide) type[0] = 'u';
  if (text == "false" && type[0] == 'u' && !is_wide) type[0] = 'i';
  return type;
}

Hdf5Axes hdf5_axes(hid_t dataset, const std::vector<std::int64_t>& shape,
                   const VariableAttributes& attributes, const std::string& name) {
  Hdf5Axes axes;
  axes.texts.resize(shape.size());
  axes.positions.resize(shape.size());
  const std::vector<std::string> labels = hdf5_texts(dataset, "DIMENSION_LABELS");
  for (std::size_t a = 0; a < labels.size() && a < shape.size(); ++a) {
    axes.texts[a].name = labels[a].substr(0, 80);
  }
  read_scales(dataset, shape, axes);
  read_tags(attributes, shape, name, axes);
  read_element_size(attributes, shape, name, axes);
  return axes;
}

Hdf5Fill hdf5_fill(hid_t dataset, const std::vector<std::int64_t>& shape, const std::string& name) {
  Hdf5Fill fill;
  const Id how(H5Dget_create_plist(dataset), H5Pclose, "the layout of a dataset");
  H5D_fill_value_t kind = H5D_FILL_VALUE_UNDEFINED;
  double value = 0;
  if (H5Pfill_value_defined(how.get(), &kind) >= 0 && kind == H5D_FILL_VALUE_USER_DEFINED &&
      H5Pget_fill_value(how.get(), H5T_NATIVE_DOUBLE, &value) >= 0 && value != 0 &&
      !std::isnan(value)) {
    fill.value = value;
  }
  std::array<char, 32> number{};
  std::snprintf(number.data(), number.size(), "%.7g", value);
  const std::string end = std::string(" never written; the values are ") + number.data();
  H5D_space_status_t status = H5D_SPACE_STATUS_ALLOCATED;
  if (const auto chunks = written_chunks(dataset, how.get(), shape)) {
    if (chunks->first < chunks->second) {
      fill.note = std::to_string(chunks->second - chunks->first) + " of " +
                  std::to_string(chunks->second) + " chunks of \"" + name + "\" were" + end +
                  " there";
    }
  } else if (H5Dget_space_status(dataset, &status) >= 0 &&
             status == H5D_SPACE_STATUS_NOT_ALLOCATED) {
    fill.note = "\"" + name + "\" was" + end;
  }
  return fill;
}

}  // namespace pellucid
