// SPDX-License-Identifier: Apache-2.0
#include "zarr_axes.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "axes/array_axes.h"
#include "axes/time_steps.h"
#include "pellucid/scene/error.h"
#include "text/printable.h"
#include "zarr_variable.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

/// Returns the axes of an image of OME-Zarr, by the names and kinds of all axes. Nothing where they
/// do not say which are those of space.
std::optional<ZarrAxes> image_axes(const OmeImage& image, const ZarrArray& array) {
  std::vector<AxisText> texts;
  for (const OmeAxis& axis : image.axes) texts.push_back({axis.name, axis.type, {}, {}});
  const NamedAxes named = named_axes(texts, array.shape);
  const auto times = std::ranges::count(named.roles, AxisRole::time);
  const bool is_whole =
      !named.is_twofold && named.unknown.empty() && named.space[0] && named.space[1] && times < 2;
  if (!is_whole) return std::nullopt;
  ZarrAxes axes;
  axes.view.space = named.space;
  axes.view.components = named.components;
  axes.view.at.assign(array.shape.size(), 0);
  axes.time = named.time;
  return axes;
}

/// Returns axes that have no names that say it: as the options do, or guessed.
ZarrAxes plain_axes(const ZarrArray& array, const std::string& name, const ReadOptions& options) {
  const ArrayAxes found = array_axes(
      array.shape, options.axes, name + ": an array of shape (" + shape_text(array.shape) + ")");
  ZarrAxes axes;
  axes.view.at.assign(array.shape.size(), 0);
  for (std::size_t place = 0; place < 3; ++place) axes.view.space[place] = found.space[place];
  if (found.components) axes.view.components = {*found.components};
  if (found.are_steps) axes.time = found.components;
  if (options.note && !found.guess.empty()) {
    options.note(name + ": " + axes_note(array.shape, found));
  }
  return axes;
}

/// Returns the axes by their names, and by what their coordinates say. Nothing where none has a
/// meaning, or there are fewer than three.
std::optional<VolumeAxes> axes_by_meaning(const fs::path& folder, const ZarrArray& array) {
  if (array.dimension_names.empty() || array.shape.size() < 3) return std::nullopt;
  ZarrVariable variable;
  variable.folder = folder;
  variable.array = array;
  if (const auto node = read_zarr_node(folder)) variable.attributes = zarr_attributes(*node);
  return volume_axes(zarr_axis_texts(variable), array.shape);
}

}  // namespace

void check_zarr_axes(const fs::path& folder, const ZarrArray& array) {
  axes_by_meaning(folder, array);
}

ZarrAxes zarr_axes(const ZarrChoice& choice, const std::string& name, const ReadOptions& options) {
  const ZarrArray& array = choice.array;
  std::optional<ZarrAxes> axes;
  if (choice.image) {
    axes = image_axes(*choice.image, array);
  } else {
    std::optional<VolumeAxes> named;
    try {
      named = axes_by_meaning(choice.folder, array);
    } catch (const Error& error) {
      throw Error(name + ": " + printable(choice.named.empty() ? "it" : choice.named) + " is " +
                  error.what());
    }
    if (named) {
      axes.emplace();
      for (std::size_t place = 0; place < 3; ++place) axes->view.space[place] = named->space[place];
      axes->view.components = named->components;
      axes->view.at.assign(array.shape.size(), 0);
      axes->time = named->time;
      axes->named = std::move(named);
    }
  }
  if (axes && options.axes) {
    throw Error(name + ": the store says which axes are x, y and z; leave the axes out");
  }
  if (axes) return *std::move(axes);
  if (choice.image && !options.axes) {
    throw Error(name +
                ": its axes are not x, y and z with t and c; say which they are, as in "
                "--array-axes czyx");
  }
  return plain_axes(array, name, options);
}

AxisPositions zarr_times(const ZarrChoice& choice, std::size_t axis, const std::string& name) {
  if (!choice.image && !choice.array.dimension_names.empty()) {
    const ZarrVariable variable = zarr_variable(choice.folder, choice.named);
    AxisPositions times = zarr_positions(variable, axis);
    if (!times.numbers.empty()) {
      times.units = printable(times.units);
      return times;
    }
  }
  const std::int64_t count = choice.array.shape[axis];
  constexpr std::int64_t most = std::int64_t{1} << 24;
  if (count > most) {
    throw Error(name + ": has " + std::to_string(count) + " steps in time, too many to be read");
  }
  const OmeLevel* const level = choice.image ? &choice.image->levels[choice.level] : nullptr;
  AxisPositions times;
  times.numbers =
      even_times(static_cast<std::size_t>(count), level == nullptr ? 0 : level->translation[axis],
                 level == nullptr ? 1 : level->scale[axis]);
  if (choice.image) times.units = printable(choice.image->axes[axis].unit);
  return times;
}

std::string zarr_holds(const ZarrChoice& choice, const ZarrAxes& axes) {
  if (axes.named) return printable(axes.named->holds);
  std::string text;
  for (const std::size_t axis : axes.view.components) {
    const bool is_time = axes.time == axis;
    const bool is_channel = !is_time && choice.image;
    text += (text.empty() ? "" : " of ") + std::to_string(choice.array.shape[axis]) +
            (is_time      ? " times"
             : is_channel ? " channels"
                          : " components");
    std::string names;
    if (is_channel) {
      for (const std::string& name : choice.image->channels) {
        names += (names.empty() ? "" : ", ") + name;
      }
    }
    if (!names.empty()) text += " (" + printable(names) + ")";
  }
  return text;
}

}  // namespace pellucid
