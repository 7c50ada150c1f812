// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "axes/time_steps.h"
#include "hdf5_format.h"
#include "meshes/mesh_blocks.h"
#include "pellucid/io/read_mesh.h"
#include "pellucid/scene/error.h"
#include "volumes/array_statistics.h"
#include "volumes/volume_format.h"
#include "vtk_hdf.h"

namespace pellucid {

namespace {

/// An array by the name that it is called by here.
struct Named {
  std::string name;
  VtkHdfArray array;
  int components = 1;
  bool in_time = false;   ///< says that its first axis is that of steps
  std::int64_t step = 0;  ///< the place on that axis

  /// Axis z; y and x follow.
  std::size_t slowest() const { return in_time ? 1 : 0; }
  Centering centering() const {
    return array.place == VtkHdfArray::Place::cell ? Centering::cell : Centering::point;
  }
};

struct Image {
  VtkHdfContents contents;
  std::array<int, 3> points{};  ///< along x, y, z
  std::vector<Named> arrays;    ///< those that can be read
  std::vector<Named> others;    ///< with the fault
  std::size_t shown = 0;        ///< of `arrays`
};

/// Returns the number of values along an axis: of cells there is one less than of points.
std::int64_t side(const Image& image, const VtkHdfArray& array, std::size_t axis) {
  return image.points[axis] - (array.place == VtkHdfArray::Place::cell ? 1 : 0);
}

void set_points(Image& image, const std::string& name) {
  const std::vector<double>& extent = image.contents.extent;
  if (extent.size() != 6) throw Error(name + ": has no WholeExtent of six numbers; it is damaged");
  for (std::size_t a = 0; a < 3; ++a) {
    const double count = extent[2 * a + 1] - extent[2 * a] + 1;
    constexpr double most = std::numeric_limits<int>::max();
    if (!(count >= 1 && count <= most)) {
      throw Error(name + ": its WholeExtent has no points along " + std::string(1, "xyz"[a]) +
                  "; it is damaged");
    }
    image.points[a] = static_cast<int>(count);
    if (image.points[a] < 2) {
      throw Error(name + ": is flat along " + std::string(1, "xyz"[a]) +
                  "; a volume has two points at least along each axis");
    }
  }
}

void add_array(Image& image, const VtkHdfArray& array) {
  if (array.place == VtkHdfArray::Place::root || array.name == ghost_flags) return;
  Named named;
  named.name = array.name;
  named.array = array;
  const auto has_name = [&](const Named& other) { return other.name == named.name; };
  if (std::ranges::any_of(image.arrays, has_name)) named.name += "_cell";
  std::string fault = array.fault;
  const std::vector<std::int64_t>& sides = array.sides;
  named.in_time = image.contents.steps > 0 && sides.size() > 3;
  const std::size_t z = named.slowest();
  if (fault.empty() && sides.size() != z + 3 && sides.size() != z + 4) {
    fault = "an array of " + std::to_string(sides.size()) + " axes";
  }
  for (std::size_t a = 0; a < 3 && fault.empty(); ++a) {
    if (sides[z + a] == side(image, array, 2 - a)) continue;
    fault = "an array of " + std::to_string(sides[z + 2]) + " x " + std::to_string(sides[z + 1]) +
            " x " + std::to_string(sides[z]) + " values, which is not what its WholeExtent says";
  }
  if (fault.empty() && sides.size() == z + 4) {
    constexpr std::int64_t most = 1 << 20;
    if (sides.back() < 1 || sides.back() > most) {
      fault = "an array of " + std::to_string(sides.back()) + " components";
    } else {
      named.components = static_cast<int>(sides.back());
    }
  }
  named.array.fault = fault;
  (fault.empty() ? image.arrays : image.others).push_back(std::move(named));
}

Image image_of(const std::filesystem::path& path) {
  const std::string name = path.string();
  Image image;
  image.contents = vtk_hdf_contents(path, "ImageData");
  set_points(image, name);
  for (const VtkHdfArray& array : image.contents.arrays) add_array(image, array);
  if (image.arrays.empty()) {
    throw Error(name + ": has no array of numbers that can be shown" +
                (image.others.empty() ? ""
                                      : "; \"" + image.others.front().name + "\" is " +
                                            image.others.front().array.fault));
  }
  const std::vector<Named>& arrays = image.arrays;
  const auto is_active = [&](const Named& n) {
    const bool point = n.centering() == Centering::point;
    const VtkHdfContents& c = image.contents;
    return n.array.name == (point ? c.point_scalars : c.cell_scalars);
  };
  auto shown = std::ranges::find_if(arrays, is_active);
  if (shown == arrays.end()) {
    shown = std::ranges::find_if(arrays, [](const Named& n) {
      return n.centering() == Centering::point && n.components == 1;
    });
  }
  if (shown == arrays.end()) shown = arrays.begin();
  image.shown = static_cast<std::size_t>(shown - arrays.begin());
  return image;
}

const Named& choose(const Image& image, const ReadOptions& options, const std::string& name) {
  if (!options.array) return image.arrays[image.shown];
  std::string list;
  for (const Named& named : image.arrays) {
    if (named.name == *options.array) return named;
    list += (list.empty() ? "" : ", ") + named.name;
  }
  for (const Named& named : image.others) {
    if (named.name == *options.array) {
      throw Error(name + ": \"" + named.name + "\" is " + named.array.fault);
    }
  }
  throw Error(name + ": has no array \"" + *options.array + "\"; its arrays are " +
              list.substr(0, 400));
}

Volume::Description describe(const Image& image, const Named& named, const std::string& name) {
  Volume::Description description;
  description.name = name;
  description.centering = named.centering();
  const VtkHdfContents& c = image.contents;
  GridPlacement& placement = description.placement;
  const bool cell = description.centering == Centering::cell;
  if (c.direction.size() == 9) {
    std::size_t n = 0;
    for (int row = 0; row < 3; ++row) {
      for (int a = 0; a < 3; ++a) placement.direction.column[a][row] = c.direction[n++];
    }
  }
  for (int a = 0; a < 3; ++a) {
    const auto axis = static_cast<std::size_t>(a);
    if (c.origin.size() == 3) placement.origin[a] = c.origin[axis];
    if (c.spacing.size() == 3) placement.spacing[a] = c.spacing[axis];
    description.dimensions[axis] = image.points[axis] - (cell ? 1 : 0);
  }
  for (int a = 0; a < 3; ++a) {
    const double first = c.extent[2 * static_cast<std::size_t>(a)] + (cell ? 0.5 : 0);
    placement.origin =
        placement.origin + placement.direction.column[a] * (placement.spacing[a] * first);
    if (placement.spacing[a] < 0) {
      placement.spacing[a] = -placement.spacing[a];
      placement.direction.column[a] = placement.direction.column[a] * -1.0;
    }
  }
  return description;
}

std::vector<VolumeData> read_values(const std::filesystem::path& path, const Named& named,
                                    ComponentRange range) {
  VtkHdfValues values(path);
  const std::optional<IndexBox> box =
      range.part != nullptr ? std::optional(range.part->box) : std::nullopt;
  const auto rows =
      named.in_time ? std::optional(std::array{named.step, std::int64_t{1}}) : std::nullopt;
  const bool has_components = named.array.sides.size() == named.slowest() + 4;
  for (int c = range.first; c < range.first + range.number; ++c) {
    values.want(named.array, has_components ? std::optional<std::int64_t>(c) : std::nullopt, box,
                rows);
  }
  values.read();
  std::vector<VolumeData> components;
  components.reserve(static_cast<std::size_t>(range.number));
  for (int c = 0; c < range.number; ++c) components.push_back(values[static_cast<std::size_t>(c)]);
  return components;
}

/// Takes the array at a step in time, by where the file says that it is.
void take_step(const VtkHdfContents& contents, std::size_t step, const std::string& name,
               Named& named) {
  const bool of_points = named.centering() == Centering::point;
  const std::string list =
      (of_points ? "PointDataOffsets/" : "CellDataOffsets/") + named.array.name;
  try {
    named.step = contents.of_step(list, step, static_cast<std::int64_t>(step));
  } catch (const Error& error) {
    throw Error(name + ": " + error.what());
  }
}

VolumeFile open_vtk_hdf(const std::filesystem::path& path, const ReadOptions& options) {
  const std::string name = path.string();
  refuse_raw_options(options, name);
  const Image image = image_of(path);
  if (std::ranges::any_of(image.contents.arrays,
                          [](const VtkHdfArray& a) { return a.name == ghost_flags; }) &&
      options.note) {
    options.note("the file marks ghost or hidden places (vtkGhostType), which are shown as any");
  }
  Named named = choose(image, options, name);
  const std::vector<double> times = image.contents.times();
  if (options.time && times.empty()) {
    throw Error(name + ": the file has no steps in time; leave the time out");
  }
  const std::size_t step = times.empty() ? 0 : nearest_step(times, options.time);
  if (!times.empty()) take_step(image.contents, step, name, named);
  if (options.note && options.time) {
    options.note(name + ": " + step_note(times, step, *options.time));
  } else if (options.note && times.size() > 1) {
    options.note(name + ": the first is read of " + times_note(times));
  }
  VolumeFile file;
  file.times = times;
  file.description = describe(image, named, name);
  apply_overrides(options, file.description);
  file.components = named.components;
  file.holds = std::to_string(named.components) + " components of \"" + named.name + "\"";
  file.array = named.name;
  file.reads_parts = true;
  file.read = [path, named](ComponentRange range) { return read_values(path, named, range); };
  return file;
}

std::vector<VolumeArray> list_vtk_hdf_arrays(const std::filesystem::path& path) {
  const Image image = image_of(path);
  std::vector<VolumeArray> list;
  for (std::size_t i = 0; i < image.arrays.size(); ++i) {
    Named named = image.arrays[i];
    if (image.contents.steps > 0) take_step(image.contents, 0, path.string(), named);
    VolumeArray about;
    about.name = named.name;
    about.centering = named.centering();
    about.type = named.array.type;
    about.is_default = i == image.shown;
    for (std::size_t a = 0; a < 3; ++a) {
      about.dimensions.push_back(static_cast<int>(named.array.sides[named.slowest() + 2 - a]));
    }
    constexpr int most = 64;
    about.more_components = std::max(named.components - most, 0);
    for (const VolumeData& values :
         read_values(path, named, {0, std::min(named.components, most)})) {
      about.components.push_back(component_statistics(values, 1).front());
    }
    list.push_back(std::move(about));
  }
  for (const Named& named : image.others) {
    VolumeArray about;
    about.name = named.name;
    about.centering = named.centering();
    about.unreadable_reason = named.array.fault;
    list.push_back(std::move(about));
  }
  return list;
}

}  // namespace

/// Files of HDF5, and of a name that says nothing else, by the group that they have.
extern const VolumeFormat vtk_hdf_format{
    .name = "VTKHDF",
    .extensions = ".vtkhdf .hdf",
    .content_owner =
        [](const std::filesystem::path& path, const VolumeFormat* by_name) {
          if (by_name != nullptr && by_name != &hdf5_format) return ContentOwner::others;
          const std::string type = vtk_hdf_type(path);
          if (type.empty()) return ContentOwner::others;
          return type == "UnstructuredGrid" ? ContentOwner::no_volume : ContentOwner::this_format;
        },
    .refuses = is_mesh_file,
    .open = open_vtk_hdf,
    .list = [](const std::filesystem::path& path,
               const ReadOptions&) { return list_vtk_hdf_arrays(path); },
    .has_times = true};

}  // namespace pellucid
