// SPDX-License-Identifier: Apache-2.0
#include "grid_files.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "axes/grid_axes.h"
#include "files/input_file.h"
#include "files/memory_limit.h"
#include "grid_answer.h"
#include "pellucid/scene/error.h"
#include "process/child_process.h"
#include "process/child_values.h"
#include "text/text.h"
#include "volumes/array_statistics.h"
#include "volumes/volume_steps.h"

namespace pellucid {

namespace {

/// Calls a module's function in a process of its own: `work` says with what, where its answer goes,
/// and whether that is well. The module is loaded there and nowhere else.
template <class Function>
std::shared_ptr<std::byte> module_in_child(
    const GridFormat& format, const char* name, const std::filesystem::path& path,
    std::size_t bytes, const std::function<bool(Function&, std::span<std::byte>)>& work) {
  const std::uintmax_t file_bytes = check_input_file(path);
  std::shared_ptr<std::byte> answer;
  try {
    module_file(format.module);  // says at once if it is not there
    answer = run_in_child(
        bytes,
        [&](std::span<std::byte> to) {
          return work(*reinterpret_cast<Function*>(module_function(format.module, name)), to);
        },
        file_bytes);
  } catch (const Error& error) {
    throw Error(path.string() + ": " + one_line(error.what()));
  }
  if (answer) return answer;
  throw Error(path.string() + ": the library that " + format.module.does +
              " fails on it, or takes far more memory or time than its size lets expect; it is "
              "damaged");
}

/// Returns a line on arrays that are no volumes.
std::string list_of(const std::vector<GridOther>& others) {
  std::string list;
  for (const GridOther& other : others) {
    list +=
        (list.empty() ? "" : ", ") + other.name + (other.is.empty() ? "" : " (" + other.is + ")");
  }
  return one_line(list.substr(0, 400));
}

GridContents contents_of(const std::filesystem::path& path, const ReadOptions& options,
                         const GridFormat& format) {
  // Room for the positions along axes; what is not written to is no memory.
  constexpr std::size_t room = std::size_t{16} << 20;
  const auto bytes = module_in_child<ListGrids>(format, list_grids_name, path, room,
                                                [&](ListGrids& list, std::span<std::byte> to) {
                                                  GridContents contents;
                                                  list(path, options.axes, contents);
                                                  return write_grid_contents(contents, to);
                                                });
  std::optional<GridContents> contents = read_grid_contents({bytes.get(), room});
  if (!contents) throw Error(path.string() + ": its list of arrays is damaged");
  if (!contents->error.empty()) throw Error(path.string() + ": " + one_line(contents->error));
  if (!contents->arrays.empty()) return *std::move(contents);
  const std::string list = list_of(contents->others);
  throw Error(path.string() + ": has no " + std::string(format.wanted) +
              (list.empty() ? "" : "; it has " + list));
}

/// With or without the slash in front.
const GridArray& choose(const GridContents& contents, const ReadOptions& options,
                        const GridFormat& format, const std::string& name) {
  if (!options.array) return contents.arrays.front();
  const auto bare = [](const std::string& text) {
    return text.starts_with('/') ? text.substr(1) : text;
  };
  std::string list;
  for (const GridArray& array : contents.arrays) {
    if (bare(array.name) == bare(*options.array)) return array;
    list += (list.empty() ? "" : ", ") + array.name;
  }
  for (const GridOther& other : contents.others) {
    if (bare(other.name) != bare(*options.array) || other.is.empty()) continue;
    throw Error(name + ": \"" + one_line(other.name) + "\" is " + one_line(other.is));
  }
  throw Error(name + ": has no array \"" + *options.array + "\", a " + std::string(format.wanted) +
              "; it has " + one_line(list.substr(0, 400)));
}

Volume::Description describe(const GridArray& array, const ReadOptions& options,
                             const std::string& name) {
  Volume::Description description;
  description.name = name;
  if (array.placement) description.placement = *array.placement;
  for (std::size_t a = 0; a < 3; ++a) description.dimensions[a] = static_cast<int>(array.sides[a]);
  ReadOptions telling = options;
  if (options.note) {
    telling.note = [&](const std::string& note) { options.note(one_line(note)); };
  }
  place_axes(description, array.positions, telling);
  return description;
}

constexpr std::array value_types{"u8", "i8", "u16", "i16", "u32", "i32", "f32", "f64"};

/// Trailer of the values that a process hands over: what went wrong, a note, and the types of the
/// components, by their numbers in value_types.
class Trailer {
 public:
  Trailer(std::span<std::byte> bytes)
      : error_(bytes.first(longest)),
        note_(bytes.subspan(longest, longest)),
        types_(bytes.subspan(2 * longest)) {}

  static std::size_t size(int components) {
    return 2 * longest + static_cast<std::size_t>(components);
  }
  void set_error(const std::string& error) const { set(error_, error); }
  std::string error() const { return text(error_); }
  void set_note(const std::string& note) const { set(note_, note); }
  std::string note() const { return text(note_); }
  void set_type(std::size_t component, const std::string& type) const {
    const auto known = std::ranges::find(value_types, type);
    types_[component] = static_cast<std::byte>(known - value_types.begin());
  }
  /// Throws Error where the bytes are none.
  std::string type(std::size_t component, const std::string& name) const {
    const auto number = std::to_integer<std::size_t>(types_[component]);
    if (number < value_types.size()) return value_types[number];
    throw Error(name + ": cannot be read; it is damaged");
  }

 private:
  static constexpr std::size_t longest = 4096;

  static void set(std::span<std::byte> bytes, const std::string& text) {
    const std::size_t length = std::min(text.size(), longest - 1);
    std::memcpy(bytes.data(), text.data(), length);
    bytes[length] = std::byte{0};
  }
  static std::string text(std::span<const std::byte> bytes) {
    const auto end = std::ranges::find(bytes, std::byte{0});
    return {reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::size_t>(end - bytes.begin())};
  }

  std::span<std::byte> error_, note_, types_;
};

std::vector<VolumeData> read_values(const std::filesystem::path& path, const GridFormat& format,
                                    const GridArray& array, const ReadOptions& options,
                                    ComponentRange range) {
  const std::string name = path.string();
  if (!array.reads_parts) range.part = nullptr;
  const std::size_t points =
      range.part != nullptr ? value_count(range.part->box) : value_count(array.sides, name);
  const std::size_t count = value_count(points, range.number, name);
  // Each component begins where any type may.
  const std::size_t largest =
      std::max(value_size(array.type, name),
               array.type_with_missing.empty() ? 0 : value_size(array.type_with_missing, name));
  check_memory(std::uintmax_t{count} * largest, name + ": its values");
  constexpr std::size_t alignment = 8;
  const std::size_t stride = (points * largest + alignment - 1) / alignment * alignment;
  const std::size_t end = stride * static_cast<std::size_t>(range.number);
  const auto bytes = module_in_child<ReadGrid>(
      format, read_grid_name, path, end + Trailer::size(range.number),
      [&](ReadGrid& read, std::span<std::byte> to) {
        const Trailer trailer(to.subspan(end));
        std::size_t component = 0;
        GridValues values;
        values.next = [&](const std::string& type) {
          trailer.set_type(component, type);
          return to.subspan(component++ * stride, points * value_size(type, name));
        };
        read(path, array.name, options.axes, range, values);
        trailer.set_error(values.error);
        trailer.set_note(values.note);
        return true;
      });
  const Trailer trailer({bytes.get() + end, Trailer::size(range.number)});
  if (const std::string error = trailer.error(); !error.empty()) {
    throw Error(name + ": " + one_line(error));
  }
  if (const std::string note = trailer.note(); options.note && !note.empty()) {
    options.note(name + ": " + one_line(note));
  }
  std::vector<VolumeData> components;
  for (std::size_t c = 0; c < static_cast<std::size_t>(range.number); ++c) {
    const std::string type = trailer.type(c, name);
    if (value_size(type, name) > largest) throw Error(name + ": cannot be read; it is damaged");
    components.push_back(child_values(bytes, c * stride, points, type));
  }
  return components;
}

}  // namespace

VolumeFile open_grid(const std::filesystem::path& path, const ReadOptions& options,
                     const GridFormat& format) {
  const std::string name = path.string();
  refuse_raw_options(options, name);
  const GridContents contents = contents_of(path, options, format);
  const GridArray array = choose(contents, options, format, name);
  value_count(array.sides, name);
  VolumeFile file;
  file.description = describe(array, options, name);
  apply_overrides(options, file.description);
  file.components = array.components;
  file.holds = one_line(array.holds + " in \"" + array.name + "\"");
  file.array = array.name;
  file.reads_parts = array.reads_parts;
  for (const std::string& note : array.notes) {
    if (options.note) options.note(name + ": " + one_line(note));
  }
  file.read = [path, &format, array, options](ComponentRange range) {
    return read_values(path, format, array, options, range);
  };
  take_steps({array.times, one_line(array.times_unit), array.components_of_a_step}, options,
             name + ": \"" + one_line(array.name) + "\" ", file);
  return file;
}

std::vector<VolumeArray> list_grid_arrays(const std::filesystem::path& path,
                                          const GridFormat& format, const ReadOptions& options) {
  const GridContents contents = contents_of(path, options, format);
  ReadOptions quiet = options;
  quiet.note = {};
  std::vector<VolumeArray> list;
  for (const GridArray& array : contents.arrays) {
    VolumeArray about;
    about.name = array.name;
    about.is_default = list.empty();
    about.dimensions.assign(array.sides.begin(), array.sides.end());
    // Each takes a process of its own.
    constexpr int most = 64;
    about.more_components = std::max(array.components - most, 0);
    about.type = array.type;
    try {
      for (int c = 0; c < std::min(array.components, most); ++c) {
        const VolumeData values = read_values(path, format, array, quiet, {c, 1}).front();
        about.type = type_name(values);
        about.components.push_back(component_statistics(values, 1).front());
      }
    } catch (const Error& error) {
      // One that cannot be read is no reason to say nothing of the others.
      const std::string message = error.what(), name = path.string() + ": ";
      about.unreadable_reason = message.starts_with(name) ? message.substr(name.size()) : message;
      about.components.clear();
      about.more_components = array.components;
    }
    list.push_back(std::move(about));
  }
  for (const GridOther& other : contents.others) {
    if (other.is.empty()) continue;
    VolumeArray about;
    about.name = one_line(other.name);
    about.unreadable_reason = one_line(other.is);
    list.push_back(std::move(about));
  }
  return list;
}

}  // namespace pellucid
