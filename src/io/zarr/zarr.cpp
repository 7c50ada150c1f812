// SPDX-License-Identifier: Apache-2.0
#include "zarr.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <system_error>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "axes/time_steps.h"
#include "meshes/mesh_blocks.h"
#include "pellucid/io/pyramid.h"
#include "pellucid/scene/error.h"
#include "text/printable.h"
#include "text/text.h"
#include "volumes/array_statistics.h"
#include "volumes/components.h"
#include "volumes/volume_format.h"
#include "zarr_axes.h"
#include "zarr_image.h"
#include "zarr_store.h"
#include "zarr_values.h"
#include "zarr_variable.h"

namespace pellucid {

namespace fs = std::filesystem;
using scene_json::Node;

namespace {

/// Tells how many values are 0 where xarray takes zeros for missing, and this library does not.
void note_zeros(const std::vector<VolumeData>& components, const std::string& name,
                const ReadOptions& options) {
  std::size_t zeros = 0;
  for (const VolumeData& data : components) {
    std::visit(
        [&](const auto& values) {
          using Value = typename std::decay_t<decltype(values)>::value_type;
          zeros += static_cast<std::size_t>(std::count(values.begin(), values.end(), Value{0}));
        },
        data);
  }
  if (zeros == 0 || !options.note) return;
  options.note(
      name + ": " + std::to_string(zeros) +
      " of its values are 0, the fill value, which xarray takes for missing (fill_value of "
      "version 2); they are shown as 0");
}

[[noreturn]] void fail_with_hint(const Error& error, const ZarrChoice& choice) {
  const std::string message = error.what();
  const bool coarser = choice.image && choice.level + 1 < choice.image->levels.size() &&
                       message.find(" of memory, but ") != std::string::npos;
  throw Error(message + (coarser ? ", or choose a coarser level (--level " +
                                       std::to_string(choice.level + 1) + ")"
                                 : ""));
}

using ReadValues = std::function<std::vector<VolumeData>(ComponentRange)>;

ReadValues image_reader(const ZarrChoice& choice, const ZarrView& view,
                        const ReadOptions& options) {
  return [choice, view, note = options.note](ComponentRange range) {
    try {
      return read_zarr_values(choice.folder, choice.array, view, range, note);
    } catch (const Error& error) {
      fail_with_hint(error, choice);
    }
  };
}

/// Reads values and turns them into what the attributes say that they mean.
ReadValues variable_reader(const ZarrVariable& variable, const ZarrView& view,
                           const std::string& name, const ReadOptions& options) {
  return [variable, view, name, options](ComponentRange range) {
    std::vector<VolumeData> values =
        read_zarr_values(variable.folder, variable.array, view, range, options.note);
    if (variable.may_hide_zeros) note_zeros(values, name, options);
    apply_meaning(values, variable.meaning);
    return values;
  };
}

/// Takes the step of the nearest time, or tells which times there are. Returns the times.
StepTimes choose_time(const ZarrChoice& choice, const ReadOptions& options, const std::string& name,
                      ZarrAxes& axes) {
  if (options.time && !axes.time) {
    throw Error(name + ": has no steps in time; leave the time out");
  }
  if (axes.time) {
    const auto z = axes.view.sides(choice.array)[2];
    refuse_movie(static_cast<std::size_t>(choice.array.shape[*axes.time]), z, options, name);
  }
  if (!axes.time) return {};
  const AxisPositions along = zarr_times(choice, *axes.time, name);
  const std::vector<double>& times = along.numbers;
  if (!options.time) {
    if (options.note && times.size() > 1)
      options.note(name + ": holds " + times_note(times, along.units));
    return {times, along.units};
  }
  if (std::ranges::all_of(times, [](double time) { return std::isnan(time); })) {
    throw Error(name +
                ": has steps, but their times are missing (NaN); choose one by its number, "
                "as a component");
  }
  const std::size_t step = nearest_step(times, options.time);
  if (options.note) options.note(name + ": " + step_note(times, step, *options.time, along.units));
  axes.view.at[*axes.time] = static_cast<std::int64_t>(step);
  std::erase(axes.view.components, *axes.time);
  return {times, along.units};
}

/// Returns the names of an image's channels where they are its components; else none.
std::vector<std::string> channel_names(const ZarrChoice& choice, const ZarrAxes& axes) {
  if (!choice.image || axes.view.components.size() != 1) return {};
  const std::size_t axis = axes.view.components.front();
  const std::vector<std::string>& names = choice.image->channels;
  const bool are_of_axis = axes.time != axis && std::ssize(names) == choice.array.shape[axis];
  return are_of_axis ? names : std::vector<std::string>();
}

/// Places a variable by its coordinates, and tells what is not read.
void place_variable(const ZarrVariable& variable, const ZarrAxes& axes, const std::string& shown,
                    const ReadOptions& options, Volume::Description& description) {
  if (!variable.array.dimension_names.empty() && !options.spacing) {
    std::array<AxisPositions, 3> positions;
    for (std::size_t place = 0; place < 3; ++place) {
      const auto axis = axes.view.space[place];
      if (axis) positions[place] = zarr_positions(variable, *axis);
    }
    place_axes(description, positions, options);
  }
  if (!options.note) return;
  const std::string& name = description.name;
  for (const std::string& note : variable.notes) options.note(name + ": " + printable(note));
  for (const std::string& note : zarr_notes(variable, shown)) {
    options.note(name + ": " + printable(note));
  }
  if (!axes.named) return;
  for (const std::string& note : axes.named->notes) {
    options.note(name + ": " + printable("\"" + shown + "\": " + note));
  }
  for (const std::string& note : zarr_notes(variable, shown, *axes.named)) {
    options.note(name + ": " + printable(note));
  }
}

}  // namespace

bool is_zarr(const fs::path& path) {
  std::error_code error;
  if (is_zarr_metadata(path)) return true;
  if (!fs::is_directory(path, error)) return false;
  fs::path bare = path;
  if (!bare.has_filename()) bare = bare.parent_path();
  return has_zarr_metadata(path) || in_small_letters(bare.filename().string()).ends_with(".zarr");
}

namespace {

/// An array of Zarr 2 or 3, or a level of an image of OME-Zarr; of groups with several the named
/// one, else the first. Axes that OME-Zarr, xarray or version 3 name are what they are named,
/// others as array_axes() has them. Channels and times are components.
VolumeFile open_zarr(const fs::path& path, const ReadOptions& options) {
  const std::string name = path.string();
  refuse_raw_options(options, name);
  ZarrChoice choice = choose_zarr(path, options);
  ZarrAxes axes = zarr_axes(choice, name, options);
  VolumeFile file;
  StepTimes steps = choose_time(choice, options, name, axes);
  file.times = std::move(steps.times);
  file.times_unit = std::move(steps.unit);
  if (options.note && !choice.array.note.empty()) options.note(name + ": " + choice.array.note);
  file.description.name = name;
  const std::array<std::int64_t, 3> sides = axes.view.sides(choice.array);
  value_count(sides, name);
  for (std::size_t a = 0; a < 3; ++a) file.description.dimensions[a] = static_cast<int>(sides[a]);
  file.components = axes.view.component_count(choice.array, name);
  file.holds = zarr_holds(choice, axes);
  file.component_names = channel_names(choice, axes);
  file.array = choice.named;
  if (choice.image) {
    place_image(choice, axes.view, options, file.description);
    file.read = image_reader(choice, axes.view, options);
  } else {
    const std::string shown =
        choice.named.empty() ? choice.folder.filename().string() : choice.named;
    const ZarrVariable variable = zarr_variable(choice.folder, printable(shown));
    place_variable(variable, axes, shown, options, file.description);
    file.read = variable_reader(variable, axes.view, name, options);
  }
  apply_overrides(options, file.description);
  return file;
}

/// The arrays and images of a group; none where the path is an array or an image. Of the options
/// only axes count.
std::vector<VolumeArray> list_zarr_arrays(const fs::path& path, const ReadOptions& given) {
  const fs::path folder = zarr_folder(path);
  const ZarrNode node = zarr_node_at(folder);
  if (node.is_array || is_zarr_image(node)) return {};
  const std::vector<ZarrEntry> entries = zarr_entries(folder);
  const std::string shown = entries.empty() ? std::string() : default_zarr_entry(folder, entries);
  std::vector<VolumeArray> list(entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const ZarrEntry& entry = entries[i];
    VolumeArray& about = list[i];
    about.name = printable(entry.path);
    about.is_default = entry.path == shown;
    try {
      ReadOptions options;
      options.array = entry.path;
      options.axes = given.axes;
      options.centering = Centering::cell;  // of a single plane, too
      const VolumeFile file = open_zarr(folder, options);
      const auto& sides = file.description.dimensions;
      about.dimensions.assign(sides.begin(), sides.end());
      about.type = kept_type(choose_zarr(folder, options).array.type);
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

}  // namespace

std::optional<Pyramid> describe_pyramid(const fs::path& path, const ReadOptions& options) {
  if (!is_zarr(path)) return std::nullopt;
  ReadOptions quiet = options;
  quiet.note = {};
  ZarrChoice choice = choose_zarr(path, quiet);
  if (!choice.image) return std::nullopt;
  const std::string name = path.string();
  const ZarrAxes axes = zarr_axes(choice, name, quiet);
  OmeImage& image = *choice.image;
  const CommonUnit unit = image_unit(image, axes.view);
  Pyramid pyramid;
  pyramid.array = choice.named;
  pyramid.shown = choice.level;
  pyramid.unit = unit.unit;
  pyramid.channels = image.channels;
  for (const OmeAxis& axis : image.axes) {
    pyramid.axes += (pyramid.axes.empty() ? "" : " ") + axis.name;
  }
  for (std::size_t i = 0; i < image.levels.size(); ++i) {
    PyramidLevel level;
    level.array = printable(image.levels[i].path);
    try {
      const ZarrArray array = zarr_array_at(path_inside(choice.group, image.levels[i].path, name));
      if (array.shape.size() == image.axes.size()) {
        const auto sides = axes.view.sides(array);
        level.dimensions.assign(sides.begin(), sides.end());
        scale_by_sides(image, i, array, choice.group);
      }
      level.spacing = image_placement(image, i, axes.view, unit, name).spacing;
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

extern const VolumeFormat zarr_format{.name = "Zarr",
                                      .extensions = ".zarr",
                                      .takes_path = is_zarr,
                                      .open = open_zarr,
                                      .list = list_zarr_arrays,
                                      .takes_axes = true,
                                      .has_levels = true,
                                      .has_times = true};

}  // namespace pellucid
