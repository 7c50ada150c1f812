// SPDX-License-Identifier: Apache-2.0
#include "zarr.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "array_axes.h"
#include "array_statistics.h"
#include "ome_zarr.h"
#include "pellucid/io/pyramid.h"
#include "pellucid/scene/error.h"
#include "text.h"
#include "volume_axes.h"
#include "zarr_metadata.h"
#include "zarr_values.h"

namespace pellucid {

namespace fs = std::filesystem;
using scene_json::Node;
using scene_json::printable;

namespace {

constexpr std::array<std::string_view, 5> metadata_files{".zarray", ".zgroup", "zarr.json",
                                                         ".zattrs", ".zmetadata"};

bool is_metadata_file(const fs::path& path) {
  const std::string name = path.filename().string();
  std::error_code error;
  return std::ranges::find(metadata_files, name) != metadata_files.end() &&
         fs::is_regular_file(path, error);
}

/// The folder of a store that a path is, or whose metadata it is.
fs::path folder_of(const fs::path& path) {
  if (!is_metadata_file(path)) return path;
  return path.parent_path().empty() ? fs::path(".") : path.parent_path();
}

// ------------------------------------------------------------------------------ nodes of a store

/// An array, or an image of several levels, in a group.
struct Entry {
  std::string path;  ///< from the group
  bool is_image = false;
};

bool is_image(const ZarrNode& node) {
  return !node.is_array && ome_attributes(node.attributes.root()).has("multiscales");
}

void find_entries(const fs::path& root, const std::string& path, int depth,
                  std::size_t& folders_left, std::vector<Entry>& found) {
  constexpr int deepest = 8;
  if (depth == deepest) return;
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(root / path, error), end; !error && entry != end;
       entry.increment(error)) {
    if (folders_left == 0) break;
    std::error_code ignored;
    if (!entry->is_directory(ignored)) continue;
    --folders_left;
    names.push_back(entry->path().filename().string());
  }
  std::ranges::sort(names, [](const std::string& a, const std::string& b) {
    // "2" before "10", as pyramids and series are numbered.
    const auto is_number = [](const std::string& text) {
      return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
    };
    return is_number(a) && is_number(b) && a.size() != b.size() ? a.size() < b.size() : a < b;
  });
  for (const std::string& name : names) {
    const std::string inner = path.empty() ? name : path + "/" + name;
    const std::optional<ZarrNode> node = read_zarr_node(root / inner);
    if (node && (node->is_array || is_image(*node))) {
      found.push_back({inner, !node->is_array});
    } else {
      find_entries(root, inner, depth + 1, folders_left, found);
    }
  }
}

std::vector<Entry> entries_of(const fs::path& folder) {
  std::size_t folders_left = 10000;
  std::vector<Entry> found;
  find_entries(folder, "", 0, folders_left, found);
  return found;
}

std::string list_of(const std::vector<Entry>& entries) {
  std::string list;
  for (const Entry& entry : entries) list += (list.empty() ? "" : ", ") + entry.path;
  return printable(list);
}

ZarrNode node_at(const fs::path& folder) {
  if (auto node = read_zarr_node(folder)) return *std::move(node);
  throw Error(folder.string() +
              ": has neither .zarray, .zgroup nor zarr.json; it is no store of Zarr, or not whole");
}

// -------------------------------------------------------------------------------- what is opened

/// An array with its place among the levels of an image, if it is one.
struct Choice {
  fs::path folder;  ///< of the array
  ZarrArray array;
  std::optional<OmeImage> image;
  std::size_t level = 0;
  fs::path group;     ///< of the image
  std::string named;  ///< path from the store to the array or the image
};

ZarrArray array_at(const fs::path& folder) {
  const ZarrNode node = node_at(folder);
  if (!node.is_array) throw Error(folder.string() + ": is a group of Zarr, no array");
  ZarrArray array = zarr_array(node);
  if (std::ranges::any_of(array.shape, [](std::int64_t side) { return side < 1; })) {
    throw Error(folder.string() + ": the array is empty, an axis has no entries");
  }
  return array;
}

/// The image that a group is, at the level that the options choose.
Choice choose_level(const fs::path& group, OmeImage image, const ReadOptions& options) {
  const std::string name = group.string();
  Choice choice;
  const int level = options.level.value_or(0);
  if (level < 0 || static_cast<std::size_t>(level) >= image.levels.size()) {
    throw Error(name + ": there is no level " + std::to_string(level) + "; it has levels 0 to " +
                std::to_string(image.levels.size() - 1));
  }
  choice.level = static_cast<std::size_t>(level);
  choice.group = group;
  choice.folder = path_inside(group, image.levels[choice.level].path, name);
  choice.array = array_at(choice.folder);
  if (image.axes.empty()) {
    // NGFF 0.1 and 0.2.
    const std::string_view letters = "tczyx";
    const std::size_t rank = choice.array.shape.size();
    if (rank > letters.size()) throw Error(name + ": has more than 5 axes");
    for (const char letter : letters.substr(letters.size() - rank)) {
      image.axes.push_back({std::string(1, letter), {}, {}});
    }
    for (OmeLevel& each : image.levels) {
      each.scale.assign(rank, 1);
      each.translation.assign(rank, 0);
    }
  }
  if (image.axes.size() != choice.array.shape.size()) {
    throw Error(name + ": lists " + std::to_string(image.axes.size()) + " axes, but its array " +
                printable(image.levels[choice.level].path) + " has " +
                std::to_string(choice.array.shape.size()));
  }
  choice.image = std::move(image);
  return choice;
}

/// Whether the array in this folder is a level of the image that its group is.
std::optional<Choice> level_of_parent(const fs::path& folder, const ReadOptions& options) {
  if (options.level) {
    throw Error(folder.string() +
                ": is an array, and has no levels; leave the level out, or give its group");
  }
  const fs::path group = fs::absolute(folder).lexically_normal();
  const fs::path bare = group.has_filename() ? group : group.parent_path();
  const auto node = read_zarr_node(bare.parent_path());
  if (!node || node->is_array) return std::nullopt;
  const auto image = parse_ome_image(node->attributes.root());
  if (!image) return std::nullopt;
  for (std::size_t i = 0; i < image->levels.size(); ++i) {
    if (fs::path(image->levels[i].path).lexically_normal() != bare.filename()) continue;
    ReadOptions of_level = options;
    of_level.level = static_cast<int>(i);
    Choice choice = choose_level(bare.parent_path(), *image, of_level);
    choice.folder = folder;
    return choice;
  }
  return std::nullopt;
}

Choice choose_array(const fs::path& folder, const ReadOptions& options) {
  if (auto choice = level_of_parent(folder, options)) return *std::move(choice);
  Choice choice;
  choice.folder = folder;
  choice.array = array_at(folder);
  return choice;
}

/// The first image of several that bioformats2raw wrote, else the first array with enough axes.
std::string default_entry(const fs::path& folder, const std::vector<Entry>& entries) {
  for (const Entry& entry : entries) {
    if (entry.is_image) return entry.path;
  }
  for (const Entry& entry : entries) {
    try {
      if (array_at(folder / entry.path).shape.size() > 2) return entry.path;
    } catch (const Error&) {
      continue;  // whoever names it is told what is wrong
    }
  }
  return entries.front().path;
}

Choice choose_in_group(const fs::path& folder, const ZarrNode& node, const ReadOptions& options) {
  const std::string name = folder.string();
  const Node ome = ome_attributes(node.attributes.root());
  if (const auto plate = ome.find("plate"); plate && !options.array) {
    throw Error(name + ": is a plate of many images; give the folder of one, as in " +
                (folder / "A/1/0").string());
  }
  const std::vector<Entry> entries = entries_of(folder);
  if (entries.empty()) throw Error(name + ": is a group of Zarr without arrays");
  const std::string path = default_entry(folder, entries);
  if (entries.size() > 1 && options.note) {
    options.note(name + ": holds " + std::to_string(entries.size()) + " arrays or images (" +
                 list_of(entries) + "); read is " + printable(path));
  }
  const fs::path chosen = folder / path;
  const ZarrNode chosen_node = node_at(chosen);
  Choice choice =
      chosen_node.is_array
          ? choose_array(chosen, options)
          : choose_level(chosen, *parse_ome_image(chosen_node.attributes.root()), options);
  choice.named = path;
  return choice;
}

Choice choose_named(const fs::path& folder, const ReadOptions& options) {
  const std::string name = folder.string();
  std::string wanted = *options.array;
  while (wanted.starts_with('/')) wanted.erase(0, 1);
  const fs::path inner = path_inside(folder, wanted, name);
  const auto node = read_zarr_node(inner);
  if (wanted.empty() || !node) {
    const std::vector<Entry> entries = entries_of(folder);
    throw Error(name + ": has no array \"" + printable(*options.array) + "\"" +
                (entries.empty() ? "" : "; it has " + list_of(entries)));
  }
  Choice choice;
  if (node->is_array) {
    choice = choose_array(inner, options);
  } else if (auto image = parse_ome_image(node->attributes.root())) {
    choice = choose_level(inner, *std::move(image), options);
  } else {
    ReadOptions rest = options;
    rest.array.reset();
    choice = choose_in_group(inner, *node, rest);
    wanted += "/" + choice.named;
  }
  choice.named = wanted;
  return choice;
}

Choice choose(const fs::path& path, const ReadOptions& options) {
  const fs::path folder = folder_of(path);
  const ZarrNode node = node_at(folder);
  if (node.is_array) {
    if (options.array) {
      throw Error(folder.string() + ": is an array; leave out the name of one");
    }
    return choose_array(folder, options);
  }
  if (options.array) return choose_named(folder, options);
  if (auto image = parse_ome_image(node.attributes.root())) {
    return choose_level(folder, *std::move(image), options);
  }
  return choose_in_group(folder, node, options);
}

// ------------------------------------------------------------------------------------------ axes

/// What an axis is by its name, in small letters: x, y, z, c or t; else 0.
char letter_of(const std::string& axis_name, const std::string& type) {
  const std::string name = in_small_letters(axis_name);
  if (type == "channel") return 'c';
  if (type == "time") return 't';
  if (name == "x" || name == "y" || name == "z" || name == "c" || name == "t") return name[0];
  if (name == "channel" || name == "channels" || name == "band" || name == "component") return 'c';
  if (name == "time") return 't';
  return '\0';
}

/// What the axes of an array are: those of space, of components and of time.
struct Axes {
  ZarrView view;
  std::optional<std::size_t> time;
};

/// By the names of all axes. Nothing where they do not say which are those of space.
std::optional<Axes> named_axes(const std::vector<char>& letters) {
  Axes axes;
  axes.view.at.assign(letters.size(), 0);
  std::vector<std::size_t> unnamed;
  for (std::size_t a = 0; a < letters.size(); ++a) {
    const std::size_t place = std::string_view("xyz").find(letters[a]);
    if (letters[a] == '\0') {
      unnamed.push_back(a);
    } else if (place != std::string_view::npos) {
      if (axes.view.space[place]) return std::nullopt;
      axes.view.space[place] = a;
    } else {
      if (letters[a] == 't' && axes.time) return std::nullopt;
      if (letters[a] == 't') axes.time = a;
      axes.view.components.push_back(a);
    }
  }
  // Others are what is missing of space, the last of them x.
  for (std::size_t place = 0; place < 3; ++place) {
    if (axes.view.space[place] || unnamed.empty()) continue;
    axes.view.space[place] = unnamed.back();
    unnamed.pop_back();
  }
  if (!unnamed.empty() || !axes.view.space[0] || !axes.view.space[1]) return std::nullopt;
  return axes;
}

/// Of an array whose axes have no names that say it: as the options do, or guessed.
Axes plain_axes(const ZarrArray& array, const std::string& name, const ReadOptions& options) {
  const ArrayAxes found = array_axes(
      array.shape, options.axes, name + ": an array of shape (" + shape_text(array.shape) + ")");
  Axes axes;
  axes.view.at.assign(array.shape.size(), 0);
  for (std::size_t place = 0; place < 3; ++place) axes.view.space[place] = found.space[place];
  if (found.components) axes.view.components = {*found.components};
  if (options.note && !found.guess.empty()) {
    options.note(name + ": " + axes_note(array.shape, found));
  }
  return axes;
}

Axes axes_of(const Choice& choice, const std::string& name, const ReadOptions& options) {
  const ZarrArray& array = choice.array;
  std::vector<char> letters;
  std::optional<Axes> named;
  if (choice.image) {
    for (const OmeAxis& axis : choice.image->axes) {
      letters.push_back(letter_of(axis.name, axis.type));
    }
    named = named_axes(letters);
  } else {
    for (const std::string& axis : array.dimension_names) letters.push_back(letter_of(axis, {}));
    const bool any_named = std::ranges::any_of(letters, [](char letter) { return letter != 0; });
    if (any_named) named = named_axes(letters);
    if (named && !named->view.space[2]) named.reset();
  }
  if (named && options.axes) {
    throw Error(name + ": the store says which axes are x, y and z; leave the axes out");
  }
  if (named) return *std::move(named);
  if (choice.image && !options.axes) {
    throw Error(name +
                ": its axes are not x, y and z with t and c; say which they are, as in "
                "--array-axes czyx");
  }
  return plain_axes(array, name, options);
}

// ------------------------------------------------------------------------------------- placement

/// The unit that all of space has, or that it is turned into; each axis' factor to it.
struct Units {
  std::string unit;
  std::array<double, 3> factor{1, 1, 1};
  std::string note;
};

Units units_of(const OmeImage& image, const ZarrView& view) {
  Units units;
  std::array<std::string, 3> said;
  bool differ = false;
  for (std::size_t place = 0; place < 3; ++place) {
    if (view.space[place]) said[place] = image.axes[*view.space[place]].unit;
    if (said[place].empty()) continue;
    if (units.unit.empty()) units.unit = said[place];
    differ = differ || said[place] != units.unit;
  }
  if (!differ) return units;
  const std::optional<double> base = metres_of(units.unit);
  for (std::size_t place = 0; place < 3; ++place) {
    if (said[place].empty()) continue;
    const std::optional<double> metres = metres_of(said[place]);
    if (!base || !metres) {
      units.factor = {1, 1, 1};
      units.note = "its units differ and are not all known; lengths are taken as they are";
      return units;
    }
    units.factor[place] = *metres / *base;
  }
  units.note = "its axes have several units; lengths are turned into " + units.unit;
  return units;
}

/// Spacing, origin and direction of a level.
GridPlacement placement_of(const OmeImage& image, std::size_t level, const ZarrView& view,
                           const Units& units, const std::string& name) {
  GridPlacement placement;
  const OmeLevel& said = image.levels[level];
  for (std::size_t place = 0; place < 3; ++place) {
    if (!view.space[place]) continue;
    const int axis = static_cast<int>(place);
    const double scale = said.scale[*view.space[place]] * units.factor[place];
    if (scale == 0 || !std::isfinite(scale)) {
      throw Error(name + ": the scale along " + std::string(1, "xyz"[axis]) +
                  " is no usable number; give --spacing");
    }
    placement.spacing[axis] = std::abs(scale);
    if (scale < 0) placement.direction.column[axis] = placement.direction.column[axis] * -1.0;
    placement.origin[axis] = said.translation[*view.space[place]] * units.factor[place];
  }
  return placement;
}

/// Where a level has no scale (before NGFF 0.4), its spacing is the share of the finest one's side.
void scale_by_sides(OmeImage& image, std::size_t level, const ZarrArray& array,
                    const fs::path& group) {
  if (level == 0 || image.levels[level].has_scale) return;
  const ZarrArray finest = array_at(path_inside(group, image.levels[0].path, group.string()));
  for (std::size_t a = 0; a < array.shape.size() && a < finest.shape.size(); ++a) {
    image.levels[level].scale[a] =
        static_cast<double>(finest.shape[a]) / static_cast<double>(array.shape[a]);
  }
}

void place_image(Choice& choice, const Axes& axes, const ReadOptions& options,
                 Volume::Description& description) {
  OmeImage& image = *choice.image;
  const std::string& name = description.name;
  scale_by_sides(image, choice.level, choice.array, choice.group);
  const Units units = units_of(image, axes.view);
  if (!options.spacing) {
    description.placement = placement_of(image, choice.level, axes.view, units, name);
  }
  if (!options.note) return;
  std::string text;
  if (image.levels.size() > 1) {
    text = "level " + std::to_string(choice.level) + " of " + std::to_string(image.levels.size()) +
           " (--level); ";
  }
  if (options.spacing) {
    text += "the spacing is the given one";
  } else if (!image.levels[choice.level].has_scale) {
    text += "it says nothing of distances; the spacing is in voxels of level 0";
  } else {
    text += "the spacing is the file's, " +
            (units.unit.empty() ? "whose unit is not stated" : "in " + units.unit);
  }
  options.note(name + ": " + text);
  if (!units.note.empty()) options.note(name + ": " + units.note);
  if (image.images > 1) {
    options.note(name + ": describes " + std::to_string(image.images) +
                 " images; the first is read");
  }
}

/// Positions along the axes, which xarray keeps in arrays of the axes' names beside the values.
void place_by_coordinates(const Choice& choice, const Axes& axes, const ReadOptions& options,
                          Volume::Description& description) {
  if (options.spacing || choice.array.dimension_names.empty()) return;
  for (std::size_t place = 0; place < 3; ++place) {
    const auto axis = axes.view.space[place];
    if (!axis || choice.array.dimension_names[*axis].empty()) continue;
    const fs::path folder =
        choice.folder.parent_path() / fs::path(choice.array.dimension_names[*axis]).filename();
    const auto node = read_zarr_node(folder);
    if (!node || !node->is_array) continue;
    const ZarrArray line = array_at(folder);
    if (line.shape != std::vector<std::int64_t>{choice.array.shape[*axis]}) continue;
    const double rounding = line.type.bytes <= 4 ? 1.2e-7 : 2.3e-16;
    const auto side = static_cast<std::size_t>(line.shape[0]);
    place_axis(description, static_cast<int>(place), read_zarr_line(folder, line, side), rounding);
  }
}

// -------------------------------------------------------------------------------------- the file

/// The step whose time is nearest.
std::int64_t step_at(const Choice& choice, std::size_t axis, double time) {
  const std::int64_t last = choice.array.shape[axis] - 1;
  const OmeLevel* const level = choice.image ? &choice.image->levels[choice.level] : nullptr;
  const double scale = level == nullptr ? 1 : level->scale[axis];
  const double begin = level == nullptr ? 0 : level->translation[axis];
  const double step = scale == 0 ? 0 : std::round((time - begin) / scale);
  if (!(step > 0)) return 0;
  return step > static_cast<double>(last) ? last : static_cast<std::int64_t>(step);
}

/// "2 times of 3 channels (DAPI, GFP, RFP)"
std::string holds_of(const Choice& choice, const Axes& axes) {
  std::string text;
  for (const std::size_t axis : axes.view.components) {
    const bool is_time = axes.time == axis;
    const bool is_channel = !is_time && (choice.image || !choice.array.dimension_names.empty());
    text += (text.empty() ? "" : " of ") + std::to_string(choice.array.shape[axis]) +
            (is_time      ? " times"
             : is_channel ? " channels"
                          : " components");
    std::string names;
    if (is_channel && choice.image) {
      for (const std::string& name : choice.image->channels) {
        names += (names.empty() ? "" : ", ") + name;
      }
    }
    if (!names.empty()) text += " (" + printable(names) + ")";
  }
  return text;
}

/// What others call packed values.
void note_packing(const Choice& choice, const ReadOptions& options, const std::string& name) {
  const auto node = read_zarr_node(choice.folder);
  if (!node || !options.note) return;
  const Node attributes = node->attributes.root();
  if (attributes.has("scale_factor") || attributes.has("add_offset")) {
    options.note(name +
                 ": its values are packed (scale_factor, add_offset) and read as they are "
                 "stored");
  }
}

[[noreturn]] void fail_with_hint(const Error& error, const Choice& choice) {
  const std::string message = error.what();
  const bool coarser = choice.image && choice.level + 1 < choice.image->levels.size() &&
                       message.find(" of memory, but ") != std::string::npos;
  throw Error(message + (coarser ? ", or choose a coarser level (--level " +
                                       std::to_string(choice.level + 1) + ")"
                                 : ""));
}

}  // namespace

bool is_zarr(const fs::path& path) {
  std::error_code error;
  if (is_metadata_file(path)) return true;
  if (!fs::is_directory(path, error)) return false;
  const bool has_metadata = std::ranges::any_of(metadata_files, [&](std::string_view file) {
    return file != ".zattrs" && fs::is_regular_file(path / file, error);
  });
  fs::path bare = path;
  if (!bare.has_filename()) bare = bare.parent_path();
  return has_metadata || in_small_letters(bare.filename().string()).ends_with(".zarr");
}

VolumeFile open_zarr(const fs::path& path, const ReadOptions& options) {
  const std::string name = path.string();
  refuse_raw_options(options, name);
  Choice choice = choose(path, options);
  Axes axes = axes_of(choice, name, options);
  if (options.time) {
    if (!axes.time) throw Error(name + ": has no steps in time; leave the time out");
    axes.view.at[*axes.time] = step_at(choice, *axes.time, *options.time);
    std::erase(axes.view.components, *axes.time);
  }
  VolumeFile file;
  file.description.name = name;
  const std::array<std::int64_t, 3> sides = axes.view.sides(choice.array);
  value_count(sides, name);
  for (std::size_t a = 0; a < 3; ++a) file.description.dimensions[a] = static_cast<int>(sides[a]);
  if (choice.image) {
    place_image(choice, axes, options, file.description);
  } else {
    place_by_coordinates(choice, axes, options, file.description);
    note_packing(choice, options, name);
  }
  apply_overrides(options, file.description);
  file.components = axes.view.component_count(choice.array, name);
  file.holds = holds_of(choice, axes);
  file.array = choice.named;
  file.read = [choice = std::move(choice), view = axes.view,
               note = options.note](ComponentRange range) {
    try {
      return read_zarr_values(choice.folder, choice.array, view, range, note);
    } catch (const Error& error) {
      fail_with_hint(error, choice);
    }
  };
  return file;
}

std::vector<VolumeArray> list_zarr_arrays(const fs::path& path, const ReadOptions& given) {
  const fs::path folder = folder_of(path);
  const ZarrNode node = node_at(folder);
  if (node.is_array || is_image(node)) return {};
  const std::vector<Entry> entries = entries_of(folder);
  const std::string shown = entries.empty() ? std::string() : default_entry(folder, entries);
  std::vector<VolumeArray> list(entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const Entry& entry = entries[i];
    VolumeArray& about = list[i];
    about.name = printable(entry.path);
    about.is_default = entry.path == shown;
    try {
      ReadOptions options;
      options.array = entry.path;
      options.axes = given.axes;
      const VolumeFile file = open_zarr(folder, options);
      const auto& sides = file.description.dimensions;
      about.dimensions.assign(sides.begin(), sides.end());
      about.type = kept_type(choose(folder, options).array.type);
      // Images are many times larger than what a listing should read.
      constexpr int most = 64;
      const int looked_at = entry.is_image ? 0 : std::min(file.components, most);
      about.more_components = file.components - looked_at;
      for (int c = 0; c < looked_at; ++c) {
        const std::vector<VolumeData> values = file.read({c, 1});
        about.type = type_name(values.front());
        about.components.push_back(component_statistics(values.front(), 1).front());
      }
    } catch (const Error& error) {
      about.unreadable_reason = error.what();
      about.components.clear();
      about.more_components = 0;
    }
  }
  return list;
}

std::optional<Pyramid> describe_pyramid(const fs::path& path, const ReadOptions& options) {
  if (!is_zarr(path)) return std::nullopt;
  ReadOptions quiet = options;
  quiet.note = {};
  Choice choice = choose(path, quiet);
  if (!choice.image) return std::nullopt;
  const std::string name = path.string();
  const Axes axes = axes_of(choice, name, quiet);
  OmeImage& image = *choice.image;
  const Units units = units_of(image, axes.view);
  Pyramid pyramid;
  pyramid.array = choice.named;
  pyramid.shown = choice.level;
  pyramid.unit = units.unit;
  pyramid.channels = image.channels;
  for (const OmeAxis& axis : image.axes) {
    pyramid.axes += (pyramid.axes.empty() ? "" : " ") + axis.name;
  }
  for (std::size_t i = 0; i < image.levels.size(); ++i) {
    PyramidLevel level;
    level.array = printable(image.levels[i].path);
    try {
      const ZarrArray array = array_at(path_inside(choice.group, image.levels[i].path, name));
      if (array.shape.size() == image.axes.size()) {
        const auto sides = axes.view.sides(array);
        level.dimensions.assign(sides.begin(), sides.end());
        scale_by_sides(image, i, array, choice.group);
      }
      level.spacing = placement_of(image, i, axes.view, units, name).spacing;
    } catch (const Error&) {
      level.dimensions.clear();  // whoever chooses it is told what is wrong
    }
    pyramid.levels.push_back(std::move(level));
  }
  if (const auto labels = read_zarr_node(choice.group / "labels"); labels && !labels->is_array) {
    const auto list = ome_attributes(labels->attributes.root()).find("labels");
    for (std::size_t i = 0; list && list->is_array() && i < list->array_size(); ++i) {
      const Node label = list->element(i);
      if (label.is_string()) pyramid.labels.push_back("labels/" + printable(label.string()));
    }
  }
  return pyramid;
}

}  // namespace pellucid
