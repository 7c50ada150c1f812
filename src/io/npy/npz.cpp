// SPDX-License-Identifier: Apache-2.0
//
// The format: numpy.savez and savez_compressed. A zip archive of files NAME.npy, one per array.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "axes/array_axes.h"
#include "axes/positions_beside.h"
#include "files/zip_archive.h"
#include "npy.h"
#include "pellucid/io/internal/parse_arrays.h"
#include "pellucid/scene/error.h"
#include "volumes/array_statistics.h"
#include "volumes/volume_format.h"
#include "write_npz.h"

namespace pellucid {

namespace {

constexpr std::string_view npy_extension = ".npy";

struct NpzArray {
  std::string name;
  ZipEntry entry;
  std::vector<std::int64_t> shape = {};  ///< by read_shapes(); empty: a single value, or no array
};

/// Makes a name printable: it is a file's in an archive, which may hold anything.
std::string printable(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; }, '?');
  return text;
}

std::vector<NpzArray> arrays_of(const ByteSource& archive) {
  std::vector<NpzArray> arrays;
  for (ZipEntry& entry : read_zip_directory(archive)) {
    if (!entry.name.ends_with(npy_extension)) continue;
    std::string name = entry.name.substr(0, entry.name.size() - npy_extension.size());
    arrays.push_back({std::move(name), std::move(entry), {}});
  }
  if (arrays.empty()) {
    throw Error(archive.name +
                ": holds no array, a file whose name ends with .npy; save one with "
                "numpy.savez");
  }
  return arrays;
}

/// Returns "a (64, 64, 64), b (3)", of the first ones.
std::string list_of(const ByteSource& archive, const std::vector<NpzArray>& arrays) {
  constexpr std::size_t longest = 1000;
  std::string list;
  for (std::size_t i = 0; i < arrays.size(); ++i) {
    if (list.size() > longest) return list + " and " + std::to_string(arrays.size() - i) + " more";
    list += (list.empty() ? "" : ", ") + printable(arrays[i].name.substr(0, 100));
    try {
      const NpyArray about = read_npy_header(zip_entry_source(archive, arrays[i].entry));
      list += " (" + shape_text(about.shape) + ")";
    } catch (const Error&) {
      list += " (not read)";
    }
  }
  return list;
}

/// Reads the shapes of all arrays.
void read_shapes(const ByteSource& archive, std::vector<NpzArray>& arrays) {
  for (NpzArray& array : arrays) {
    try {
      array.shape = read_npy_header(zip_entry_source(archive, array.entry)).shape;
    } catch (const Error&) {
      continue;  // is told where the array is chosen or listed
    }
  }
}

/// Returns the other arrays of the archive, with the numbers of those that may say positions.
std::vector<ArrayBeside> arrays_beside(const ByteSource& archive,
                                       const std::vector<NpzArray>& arrays, const NpzArray& array) {
  std::vector<ArrayBeside> beside;
  const bool has_others = std::ranges::any_of(arrays, [&](const NpzArray& other) {
    return other.shape.size() > 2 && other.shape != array.shape;
  });
  for (const NpzArray& other : arrays) {
    if (other.name == array.name) continue;
    ArrayBeside about{printable(other.name), other.shape};
    about.is_of_several = has_others;
    if (may_say_positions(about, array.shape)) {
      try {
        about.numbers = read_npy_numbers(zip_entry_source(archive, other.entry));
      } catch (const Error&) {
        about.numbers.clear();  // text and objects of Python, which are told of
      }
    }
    beside.push_back(std::move(about));
  }
  return beside;
}

VolumeFile open_array(const ByteSource& archive, const NpzArray& array, const ReadOptions& options,
                      std::span<const ArrayBeside> beside = {}) {
  VolumeFile file = open_npy_alone(zip_entry_source(archive, array.entry), options, beside);
  file.description.name = archive.name;
  file.array = printable(array.name);
  return file;
}

/// Returns whether the header of the array is that of a volume.
bool is_volume(const ByteSource& archive, const NpzArray& array, ReadOptions options) {
  options.note = {};
  try {
    open_array(archive, array, options);
    return true;
  } catch (const Error&) {
    return false;
  }
}

const NpzArray& choose(const ByteSource& archive, const std::vector<NpzArray>& arrays,
                       const ReadOptions& options) {
  if (options.array) {
    // As in Python, the last of a name is the one that it is the name of.
    for (auto array = arrays.rbegin(); array != arrays.rend(); ++array) {
      if (array->name == *options.array || array->entry.name == *options.array ||
          printable(array->name) == *options.array) {
        return *array;
      }
    }
    throw Error(archive.name + ": has no array \"" + printable(options.array->substr(0, 100)) +
                "\"; it has " + list_of(archive, arrays));
  }
  if (arrays.size() == 1) return arrays.front();
  const NpzArray* only = nullptr;
  for (const NpzArray& array : arrays) {
    if (!is_volume(archive, array, options)) continue;
    if (only != nullptr) {
      throw Error(archive.name + ": holds several arrays; choose one of them by its name: " +
                  list_of(archive, arrays));
    }
    only = &array;
  }
  if (only == nullptr) {
    throw Error(archive.name + ": holds no array of three or four axes of numbers; it has " +
                list_of(archive, arrays));
  }
  if (options.note) {
    options.note(archive.name + ": the array " + printable(only->name) +
                 " is taken, the only one that is a volume");
  }
  return *only;
}

/// Returns the name of the space of the world, where an array has its letters; else nothing.
std::string space_of(const ByteSource& archive, const std::vector<NpzArray>& arrays) {
  constexpr std::int64_t longest = 64;
  const auto space = std::ranges::find(arrays, npz_space, &NpzArray::name);
  if (space == arrays.end() || space->shape.size() != 1 || space->shape[0] > longest) return "";
  std::string name;
  try {
    for (const double letter : read_npy_numbers(zip_entry_source(archive, space->entry))) {
      if (!(letter >= ' ' && letter <= '~')) return "";
      name += static_cast<char>(letter);
    }
  } catch (const Error&) {
    return "";
  }
  return name;
}

VolumeFile open_npz(const ByteSource& source, const ReadOptions& options) {
  refuse_raw_options(options, source.name);
  std::vector<NpzArray> arrays = arrays_of(source);
  read_shapes(source, arrays);
  const NpzArray& chosen = choose(source, arrays, options);
  VolumeFile file = open_array(source, chosen, options, arrays_beside(source, arrays, chosen));
  file.space = space_of(source, arrays);
  return file;
}

std::vector<VolumeArray> list_npz_arrays(const std::filesystem::path& path,
                                         const ReadOptions& options) {
  const ByteSource archive = file_source(path);
  std::vector<VolumeArray> list;
  bool shown = false;
  std::vector<NpzArray> arrays = arrays_of(archive);
  read_shapes(archive, arrays);
  for (const NpzArray& array : arrays) {
    VolumeArray about;
    about.name = printable(array.name);
    try {
      ReadOptions quiet = options;
      quiet.note = {};
      const VolumeFile file =
          open_array(archive, array, quiet, arrays_beside(archive, arrays, array));
      const auto& sides = file.description.dimensions;
      about.dimensions.assign(sides.begin(), sides.end());
      constexpr int most = 64;
      const int looked_at = std::min(file.components, most);
      about.more_components = file.components - looked_at;
      for (const VolumeData& values : file.read({0, looked_at})) {
        about.type = type_name(values);
        about.components.push_back(component_statistics(values, 1).front());
      }
      about.is_default = !std::exchange(shown, true);
    } catch (const Error& error) {
      const std::string message = error.what(), prefix = path.string() + ": ";
      about.unreadable_reason =
          message.starts_with(prefix) ? message.substr(prefix.size()) : message;
      about.components.clear();
    }
    list.push_back(std::move(about));
  }
  return list;
}

}  // namespace

Volume parse_npz(const std::vector<std::byte>& bytes, const std::string& name,
                 const ReadOptions& options) {
  return read_chosen(open_npz(memory_source(bytes, name), options), options);
}

extern const VolumeFormat npz_format{
    .name = "NumPy archive",
    .extensions = ".npz",
    .open = [](const std::filesystem::path& path,
               const ReadOptions& options) { return open_npz(file_source(path), options); },
    .list = list_npz_arrays,
    .takes_axes = true,
    .has_times = true,
    .is_of_patients = true};

}  // namespace pellucid
