// SPDX-License-Identifier: Apache-2.0
//
// What vtkHttpDataSetReader of vtk.js reads and vtkJSONDataSetWriter of VTK writes: index.json with
// the image's extent, origin, spacing and direction, and a list of arrays, each of which names a
// file of its values by "ref": basepath/id, or that and ".gz".

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "files/gzip_source.h"
#include "pellucid/scene/error.h"
#include "text/json_file.h"
#include "text/printable.h"
#include "volumes/array_statistics.h"
#include "volumes/components.h"
#include "volumes/volume_format.h"

namespace pellucid {

namespace fs = std::filesystem;
using scene_json::Node;

namespace {

constexpr const char* index_name = "index.json";

fs::path index_of(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error) ? path / index_name : path;
}

/// One of the lists of arrays.
struct Array {
  std::string name, type;
  Centering centering = Centering::point;
  int components = 1;
  std::uint64_t size = 0;  ///< values of all components
  bool big_endian = false;
  fs::path file;
  bool is_active = false;
  std::string unreadable_reason;  ///< why; empty: it is
};

struct Image {
  std::array<std::int64_t, 3> points{1, 1, 1};
  std::array<std::int64_t, 3> first{0, 0, 0};
  GridPlacement placement;
  std::vector<Array> arrays;
};

std::string type_of(const Node& node) {
  static constexpr std::pair<const char*, const char*> types[] = {
      {"Uint8Array", "u8"},     {"Uint8ClampedArray", "u8"}, {"Int8Array", "i8"},
      {"Uint16Array", "u16"},   {"Int16Array", "i16"},       {"Uint32Array", "u32"},
      {"Int32Array", "i32"},    {"Float32Array", "f32"},     {"Float64Array", "f64"},
      {"BigInt64Array", "i64"}, {"BigUint64Array", "u64"}};
  for (const auto& [known, type] : types) {
    if (node.string() == known) return type;
  }
  node.fail("\"" + printable(node.string()) + "\" is no type of numbers");
}

/// Returns the file of an array, compressed or not. Throws Error.
fs::path file_of(const Node& ref, const fs::path& folder, const std::string& name) {
  const auto base = ref.find("basepath");
  const std::string& id = ref.at("id", "name the file").string();
  const fs::path inner =
      base && !base->string().empty() ? fs::path(base->string()) / id : fs::path(id);
  const fs::path file = path_inside(folder, inner.string(), name);
  std::error_code error;
  if (fs::exists(file, error)) return file;
  fs::path compressed = file;
  compressed += ".gz";
  return fs::exists(compressed, error) ? compressed : file;
}

Array array_of(const Node& data, const fs::path& folder, const std::string& name) {
  Array array;
  const auto text = data.find("name");
  array.name = text && text->is_string() ? printable(text->string()) : std::string();
  array.components = 1;
  if (const auto count = data.find("numberOfComponents")) {
    array.components = static_cast<int>(count->integer(1, std::numeric_limits<int>::max()));
  }
  array.type = type_of(data.at("dataType", "give the type of the numbers"));
  const auto size = data.find("size");
  constexpr long long most = 1LL << 50;
  array.size = size ? static_cast<std::uint64_t>(size->integer(0, most)) : 0;
  const auto ref = data.find("ref");
  if (!ref || ref->is_null()) {
    data.fail(
        "has its values in the file itself, which is not read; save it with its values in "
        "files of their own");
  }
  if (const auto encode = ref->find("encode")) {
    const std::string& word = encode->string();
    array.big_endian = word == "BigEndian";
    if (word != "BigEndian" && word != "LittleEndian") {
      encode->fail("values written as \"" + printable(word) + "\" are not read");
    }
  }
  array.file = file_of(*ref, folder, name);
  const auto registration = ref->find("registration");
  array.is_active =
      registration && registration->is_string() && registration->string() == "setScalars";
  return array;
}

void add_arrays(const Node& root, const char* key, Centering centering, const fs::path& folder,
                Image& image) {
  const auto attributes = root.find(key);
  const auto list = attributes ? attributes->find("arrays") : std::nullopt;
  if (!list || list->is_null()) return;
  std::optional<std::int64_t> active;
  if (const auto number = attributes->find("activeScalars"); number && number->is_number()) {
    active = number->integer(-1, std::numeric_limits<int>::max());
  }
  for (std::size_t i = 0; i < list->array_size(); ++i) {
    const Node entry = list->element(i);
    const Node data = entry.has("data") ? entry.at("data", "") : entry;
    Array array;
    try {
      array = array_of(data, folder, folder.string());
    } catch (const Error& error) {
      const auto name = data.find("name");
      array.name = name && name->is_string() ? printable(name->string()) : std::string();
      array.unreadable_reason = error.what();
    }
    if (array.name.empty()) array.name = "array " + std::to_string(i);
    array.is_active = array.is_active || active == static_cast<std::int64_t>(i);
    array.centering = centering;
    image.arrays.push_back(std::move(array));
  }
}

std::array<double, 3> three(const Node& node) {
  if (node.array_size() != 3) node.fail("must have 3 numbers");
  return {node.element(0).number(), node.element(1).number(), node.element(2).number()};
}

void read_extent(const Node& root, Image& image) {
  constexpr long long most = std::numeric_limits<int>::max();
  if (const auto extent = root.find("extent")) {
    if (extent->array_size() != 6) extent->fail("must have 6 numbers");
    for (std::size_t a = 0; a < 3; ++a) {
      const long long first = extent->element(2 * a).integer(-most, most);
      const long long last = extent->element(2 * a + 1).integer(-most, most);
      if (last < first) extent->fail("ends before it begins; the image is empty");
      image.first[a] = first;
      image.points[a] = last - first + 1;
    }
    return;
  }
  const Node sides = root.at("dimensions", "give it or \"extent\"");
  if (sides.array_size() != 3) sides.fail("must have 3 numbers");
  for (std::size_t a = 0; a < 3; ++a) image.points[a] = sides.element(a).integer(1, most);
}

void read_placement(const Node& root, Image& image) {
  GridPlacement& placement = image.placement;
  if (const auto spacing = root.find("spacing")) {
    const std::array<double, 3> said = three(*spacing);
    for (int a = 0; a < 3; ++a) placement.spacing[a] = said[static_cast<std::size_t>(a)];
  }
  if (const auto direction = root.find("direction"); direction && !direction->is_null()) {
    // As gl-matrix has it: axis by axis.
    if (direction->array_size() != 9) direction->fail("must have 9 numbers");
    std::size_t n = 0;
    for (int a = 0; a < 3; ++a) {
      for (int i = 0; i < 3; ++i) {
        placement.direction.column[a][i] = direction->element(n++).number();
      }
    }
  }
  if (const auto origin = root.find("origin")) {
    const std::array<double, 3> said = three(*origin);
    for (int a = 0; a < 3; ++a) placement.origin[a] = said[static_cast<std::size_t>(a)];
  }
  // The origin is that of index 0, which the extent need not hold.
  for (int a = 0; a < 3; ++a) {
    const double steps = static_cast<double>(image.first[static_cast<std::size_t>(a)]);
    placement.origin =
        placement.origin + placement.direction.column[a] * (steps * placement.spacing[a]);
  }
}

Image read_image(const fs::path& path) {
  const fs::path index = index_of(path);
  const JsonFile file = read_data_json(index);
  const Node root = file.root();
  if (!root.is_object()) root.fail("must be an object");
  if (root.has("scene")) {
    root.fail("is a scene of vtk.js; give the folder of one of its data sets");
  }
  const std::string& kind = root.at("vtkClass", "it must be \"vtkImageData\"").string();
  if (kind != "vtkImageData") {
    root.fail("is a " + printable(kind) + " of vtk.js, and only its vtkImageData is read");
  }
  Image image;
  read_extent(root, image);
  read_placement(root, image);
  const fs::path folder = index.parent_path().empty() ? fs::path(".") : index.parent_path();
  add_arrays(root, "pointData", Centering::point, folder, image);
  add_arrays(root, "cellData", Centering::cell, folder, image);
  if (image.arrays.empty()) root.fail("has no array of points or cells");
  return image;
}

/// Returns the active scalars, else the first of one component, else the first that is read.
const Array& default_array(const Image& image, const std::string& name) {
  const auto readable = [](const Array& array) { return array.unreadable_reason.empty(); };
  for (const Array& array : image.arrays) {
    if (readable(array) && array.is_active) return array;
  }
  for (const Array& array : image.arrays) {
    if (readable(array) && array.components == 1) return array;
  }
  const auto first = std::ranges::find_if(image.arrays, readable);
  if (first != image.arrays.end()) return *first;
  throw Error(name + ": no array can be read; " + image.arrays.front().unreadable_reason);
}

const Array& choose(const Image& image, const ReadOptions& options, const std::string& name) {
  if (!options.array) return default_array(image, name);
  std::string list;
  for (const Array& array : image.arrays) {
    if (array.name == *options.array) {
      if (!array.unreadable_reason.empty()) throw Error(array.unreadable_reason);
      return array;
    }
    list += (list.empty() ? "" : ", ") + array.name;
  }
  throw Error(name + ": has no array \"" + printable(*options.array) + "\"; it has " +
              printable(list));
}

VolumeFile open_array(const Image& image, const Array& array, const ReadOptions& options,
                      const std::string& name) {
  VolumeFile file;
  file.description.name = name;
  file.description.centering = array.centering;
  file.description.placement = image.placement;
  std::array<std::int64_t, 3> sides = image.points;
  if (array.centering == Centering::cell) {
    for (std::size_t a = 0; a < 3; ++a) {
      const int axis = static_cast<int>(a);
      sides[a] = std::max<std::int64_t>(sides[a] - 1, 1);
      GridPlacement& placement = file.description.placement;
      if (image.points[a] == 1) continue;
      placement.origin =
          placement.origin + placement.direction.column[axis] * (placement.spacing[axis] / 2);
    }
  }
  const std::size_t points = value_count(sides, name);
  const std::size_t count = value_count(points, array.components, name);
  if (array.size != 0 && array.size != count) {
    throw Error(name + ": the array \"" + array.name + "\" has " + std::to_string(array.size) +
                " values, but the image needs " + std::to_string(count));
  }
  for (std::size_t a = 0; a < 3; ++a) file.description.dimensions[a] = static_cast<int>(sides[a]);
  apply_overrides(options, file.description);
  file.components = array.components;
  file.holds = std::to_string(array.components) + " components in \"" + array.name + "\"";
  file.array = array.name;
  file.read = [array, points, note = options.note](ComponentRange range) {
    const ByteSource source = plain_or_gzip_source(array.file);
    const std::uintmax_t needed = std::uintmax_t{points} *
                                  static_cast<std::uintmax_t>(array.components) *
                                  value_size(array.type, source.name);
    if (source.size != needed) {
      throw Error(source.name + ": holds " + std::to_string(source.size) +
                  " bytes of values, but the image needs " + std::to_string(needed) +
                  "; it is cut off or of another image");
    }
    const ValueLayout layout{array.type, array.big_endian, 0, array.components, true, note};
    return read_components(source, layout, points, range);
  };
  return file;
}

/// Reads the values of an array for a listing.
void look_at(const VolumeFile& file, VolumeArray& about) {
  const auto& sides = file.description.dimensions;
  about.dimensions.assign(sides.begin(), sides.end());
  constexpr int most = 64;
  const int looked_at = std::min(file.components, most);
  about.more_components = file.components - looked_at;
  for (int c = 0; c < looked_at; ++c) {
    const std::vector<VolumeData> values = file.read({c, 1});
    about.type = type_name(values.front());
    about.components.push_back(component_statistics(values.front(), 1).front());
  }
}

/// Returns whether a path is a data set of vtk.js (vtkHttpDataSetReader): a folder with an
/// index.json that has a "vtkClass", or this file.
bool is_vtk_js(const fs::path& path) {
  std::error_code error;
  const fs::path index = index_of(path);
  if (index.filename() != index_name || !fs::is_regular_file(index, error)) return false;
  try {
    const JsonFile file = read_data_json(index);
    return file.root().has("vtkClass") || file.root().has("scene");
  } catch (const Error&) {
    return path == index;  // whoever names it is told what is wrong
  }
}

/// An image: an array of points, or one of cells, which is cell-centred.
VolumeFile open_vtk_js(const fs::path& path, const ReadOptions& options) {
  const std::string name = path.string();
  refuse_raw_options(options, name);
  const Image image = read_image(path);
  return open_array(image, choose(image, options, name), options, name);
}

std::vector<VolumeArray> list_vtk_js_arrays(const fs::path& path) {
  const std::string name = path.string();
  const Image image = read_image(path);
  const Array& shown = default_array(image, name);
  std::vector<VolumeArray> list(image.arrays.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Array& array = image.arrays[i];
    VolumeArray& about = list[i];
    about.name = array.name;
    about.centering = array.centering;
    about.type = array.type;
    about.is_default = &array == &shown;
    about.unreadable_reason = array.unreadable_reason;
    if (!about.unreadable_reason.empty()) continue;
    try {
      look_at(open_array(image, array, {}, name), about);
    } catch (const Error& error) {
      about.unreadable_reason = error.what();
      about.components.clear();
      about.more_components = 0;
    }
  }
  return list;
}

}  // namespace

extern const VolumeFormat vtk_js_format{
    .name = "vtk.js",
    .takes_path = is_vtk_js,
    .open = open_vtk_js,
    .list = [](const fs::path& path, const ReadOptions&) { return list_vtk_js_arrays(path); },
    .is_json = true};

}  // namespace pellucid
