// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/read_volume.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "axes/time_steps.h"
#include "components.h"
#include "dicom/dicom_slices.h"
#include "pellucid/io/internal/color_data.h"
#include "pellucid/scene/error.h"
#include "volume_format.h"
#include "volume_steps.h"

namespace pellucid {

namespace {

VolumeFile open_file(const std::filesystem::path& path, const ReadOptions& options) {
  if (options.time && !std::isfinite(*options.time)) {
    throw Error(path.string() + ": the time is no finite number; give that of a step");
  }
  const VolumeFormat& format = find_volume_format(path, options);
  if (options.series && !format.has_series) {
    throw Error(path.string() + ": is no DICOM, and only of DICOM a series may be chosen");
  }
  if (options.array && format.list == nullptr) {
    throw Error(path.string() + ": has no arrays with names; leave the array out");
  }
  if (options.axes && !format.takes_axes) {
    throw Error(path.string() + ": the file's format says which axes are x, y and z; leave the " +
                "axes out (they are for .npy, .npz, HDF5, Zarr and tifffile's arrays)");
  }
  if (options.level && !format.has_levels) {
    throw Error(path.string() + ": has no levels of resolution; leave the level out");
  }
  if (options.time && !format.has_times) {
    throw Error(path.string() + ": the file has no steps in time; leave the time out");
  }
  return format.open(path, options);
}

/// Returns the result of `read` for the opened file, with one line for all that memory does not
/// hold.
template <class Read>
auto with_memory(const std::filesystem::path& path, const Read& read) {
  try {
    return read();
  } catch (const std::bad_alloc&) {
    throw Error(path.string() + ": not enough memory for the data; crop or reduce the volume");
  } catch (const std::length_error&) {
    throw Error(path.string() + ": not enough memory for the data; crop or reduce the volume");
  }
}

/// Returns the same, opened again without the files of a DICOM series that turn out to be damaged.
/// Notes are told once, and only if there is no error, which is then the one line.
template <class Read>
auto open_and(const std::filesystem::path& path, const ReadOptions& options, const Read& read) {
  std::vector<std::string> notes;
  ReadOptions once = options;
  if (options.note) {
    once.note = [&](const std::string& text) {
      if (std::ranges::find(notes, text) == notes.end()) notes.push_back(text);
    };
  }
  auto made = with_memory(path, [&] {
    try {
      return read(open_file(path, once));
    } catch (const DamagedDicom& damaged) {
      const VolumeFormat& format = find_volume_format(path, once);
      return read(format.open_without(damaged.files(), path, once));
    }
  });
  for (const std::string& text : notes) options.note(text);
  return made;
}

/// Returns the steps around the time that the options ask for, where values are to be linear
/// between them.
std::optional<MomentBetween> moment_of(const std::filesystem::path& path,
                                       const ReadOptions& options) {
  if (options.time_between != TimeBetween::linear) return std::nullopt;
  if (!options.time) {
    throw Error(path.string() + ": linear between steps in time needs a time; give one");
  }
  return moment_between(volume_times(path, options).times, *options.time);
}

/// Returns what `mix` makes of the results of `read` at both steps. Notes are told once, and only
/// if there is no error.
template <class Read, class Mix>
auto read_between(const std::filesystem::path& path, const ReadOptions& options,
                  const MomentBetween& moment, const Read& read, const Mix& mix) {
  std::vector<std::string> notes;
  ReadOptions at = options;
  at.time_between = TimeBetween::nearest;
  if (options.note) {
    at.note = [&](const std::string& text) {
      if (std::ranges::find(notes, text) == notes.end()) notes.push_back(text);
    };
  }
  at.time = moment.before;
  auto before = read(at);
  at.time = moment.after;
  auto after = read(at);
  auto mixed = with_memory(path, [&] { return mix(before, after); });
  if (!options.note) return mixed;
  for (const std::string& text : notes) options.note(text);
  options.note(path.string() + ": " + moment_note(moment, *options.time));
  return mixed;
}

}  // namespace

VolumeOutline outline_volume(const std::filesystem::path& path, const ReadOptions& options) {
  return open_and(path, options, [](const VolumeFile& file) {
    return VolumeOutline{file.description, file.reads_parts, file.space};
  });
}

Volume read_volume(const std::filesystem::path& path, const ReadOptions& options) {
  if (const std::optional<MomentBetween> moment = moment_of(path, options)) {
    return read_between(
        path, options, *moment, [&](const ReadOptions& at) { return read_volume(path, at); },
        [&](const Volume& before, const Volume& after) {
          return volume_between(before, after, path.string(), moment->share);
        });
  }
  return open_and(path, options,
                  [&](const VolumeFile& file) { return read_chosen(file, options); });
}

StepTimes volume_times(const std::filesystem::path& path, const ReadOptions& options) {
  ReadOptions quiet = options;
  quiet.time.reset();
  quiet.part = {};
  quiet.note = {};
  const auto times = find_volume_format(path, quiet).times;
  if (times != nullptr) return with_memory(path, [&] { return times(path, quiet); });
  return open_and(path, quiet, [](const VolumeFile& file) {
    return StepTimes{file.times, file.times_unit};
  });
}

ColorOutline outline_colors(const std::filesystem::path& path, const ReadOptions& options) {
  return open_and(path, options, [](const VolumeFile& file) {
    if (!(file.largest_color > 0)) return ColorOutline{};
    const Volume::Description& grid = file.description;
    const auto side = [&](int a) {
      const auto axis = static_cast<std::size_t>(a);
      const std::vector<double>& places = grid.coordinates[axis];
      return places.empty() ? grid.dimensions[axis] * grid.placement.spacing[a]
                            : places.back() - places.front();
    };
    const double x = side(0), y = side(1), z = side(2);
    return ColorOutline{file.components, file.largest_color,
                        2 * x * y * z / (x * y + y * z + z * x)};
  });
}

int component_count(const std::filesystem::path& path, const ReadOptions& options) {
  return open_and(path, options, [](const VolumeFile& file) { return file.components; });
}

std::vector<Volume> read_components(const std::filesystem::path& path, const ReadOptions& options) {
  return read_named_components(path, options).components;
}

NamedComponents read_named_components(const std::filesystem::path& path,
                                      const ReadOptions& options) {
  if (const std::optional<MomentBetween> moment = moment_of(path, options)) {
    return read_between(
        path, options, *moment,
        [&](const ReadOptions& at) { return read_named_components(path, at); },
        [&](NamedComponents& before, const NamedComponents& after) {
          const std::size_t count = std::min(before.components.size(), after.components.size());
          for (std::size_t c = 0; c < count; ++c) {
            before.components[c] = volume_between(before.components[c], after.components[c],
                                                  path.string(), moment->share);
          }
          return std::move(before);
        });
  }
  return open_and(path, options, [&](const VolumeFile& file) {
    return NamedComponents{file.array, read_all(file, options)};
  });
}

std::vector<VolumeArray> list_arrays(const std::filesystem::path& path,
                                     const ReadOptions& options) {
  return with_memory(path, [&]() -> std::vector<VolumeArray> {
    const auto list = find_volume_format(path, options).list;
    return list == nullptr ? std::vector<VolumeArray>{} : list(path, options);
  });
}

std::string world_space(const std::filesystem::path& file, const ReadOptions& options) {
  ReadOptions silent = options;
  silent.note = {};
  silent.part = {};
  try {
    if (!find_volume_format(file, silent).is_of_patients) return {};
    return outline_volume(file, silent).space;
  } catch (const Error&) {
    return {};
  }
}

bool is_placed_in_lps(const std::filesystem::path& file, const ReadOptions& options) {
  return world_space(file, options) == patient_space;
}

}  // namespace pellucid
