// SPDX-License-Identifier: Apache-2.0
#include "grid_files.h"

#include <algorithm>
#include <mutex>
#include <string>
#include <type_traits>
#include <utility>

#include "array_statistics.h"
#include "grid_module.h"
#include "input_file.h"
#include "memory_limit.h"
#include "mesh_blocks.h"
#include "module.h"
#include "net_cdf_size.h"
#include "pellucid/scene/error.h"
#include "volume_axes.h"

namespace pellucid {

namespace {

#ifdef PELLUCID_HAVE_HDF5
constexpr bool has_hdf5 = true;
#else
constexpr bool has_hdf5 = false;
#endif
#ifdef PELLUCID_HAVE_NETCDF
constexpr bool has_net_cdf = true;
#else
constexpr bool has_net_cdf = false;
#endif

constexpr Module hdf5{"pellucid_hdf5.so", "HDF5 files", has_hdf5,
                      "HDF5 (Debian: libhdf5-dev) and -DPELLUCID_WITH_HDF5=ON"};
constexpr Module net_cdf{"pellucid_netcdf.so", "NetCDF files", has_net_cdf,
                         "NetCDF (Debian: libnetcdf-dev) and -DPELLUCID_WITH_NETCDF=ON"};

std::mutex one_at_a_time;

constexpr const char* wanted = "array of three or four axes of numbers";

/// Calls a module's function. Both modules stand on Debian's HDF5, which may be in one thread at a
/// time. Libraries are kept once they are loaded, which takes dlopen() each time to find out.
template <class Function, class... Arguments>
void call(const Module& module, const char* name, Arguments&&... arguments) {
  static_assert(std::is_invocable_v<Function, Arguments...>);
  const std::lock_guard lock(one_at_a_time);
  (*reinterpret_cast<Function*>(module_function(module, name)))(arguments...);
}

GridContents contents_of(const std::filesystem::path& path, const Module& module) {
  check_input_file(path);
  GridContents contents;
  try {
    call<ListGrids>(module, list_grids_name, path, contents);
  } catch (const Error& error) {
    throw Error(path.string() + ": " + error.what());
  }
  if (!contents.error.empty()) throw Error(path.string() + ": " + contents.error);
  if (!contents.arrays.empty()) return contents;
  std::string list;
  for (const std::string& other : contents.others) list += (list.empty() ? "" : ", ") + other;
  throw Error(path.string() + ": has no " + std::string(wanted) +
              (list.empty() ? "" : "; it has " + list.substr(0, 400)));
}

/// With or without the slash in front.
const GridArray& choose(const GridContents& contents, const ReadOptions& options,
                        const std::string& name) {
  if (!options.array) return contents.arrays.front();
  const auto bare = [](const std::string& text) {
    return text.starts_with('/') ? text.substr(1) : text;
  };
  std::string list;
  for (const GridArray& array : contents.arrays) {
    if (bare(array.name) == bare(*options.array)) return array;
    list += (list.empty() ? "" : ", ") + array.name;
  }
  throw Error(name + ": has no array \"" + *options.array + "\", a " + std::string(wanted) +
              "; it has " + list.substr(0, 400));
}

Volume::Description describe(const GridArray& array, const ReadOptions& options,
                             const std::string& name) {
  Volume::Description description;
  description.name = name;
  for (std::size_t a = 0; a < 3; ++a) {
    description.dimensions[a] = static_cast<int>(array.sides[a]);
    // A spacing that is given is that of the values, wherever the file has them.
    if (options.spacing || array.positions[a].empty()) continue;
    try {
      place_axis(description, static_cast<int>(a), array.positions[a], array.rounding[a]);
    } catch (const Error& error) {
      throw Error(std::string(error.what()) + ", or give a spacing");
    }
  }
  return description;
}

std::vector<VolumeData> read_values(const std::filesystem::path& path, const Module& module,
                                    const GridArray& array, ComponentRange range) {
  const std::string name = path.string();
  const std::size_t points = value_count(array.sides, name);
  check_memory(
      std::uintmax_t{value_count(points, range.number, name)} * value_size(array.type, name),
      name + ": its values");
  GridValues values;
  call<ReadGrid>(module, read_grid_name, path, array.name, range, values);
  if (!values.error.empty()) throw Error(name + ": " + values.error);
  return std::move(values.components);
}

VolumeFile open_grid(const std::filesystem::path& path, const ReadOptions& options,
                     const Module& module) {
  const std::string name = path.string();
  refuse_raw_options(options, name);
  const GridContents contents = contents_of(path, module);
  const GridArray array = choose(contents, options, name);
  value_count(array.sides, name);
  VolumeFile file;
  file.description = describe(array, options, name);
  apply_overrides(options, file.description);
  file.components = array.components;
  file.holds = array.holds + " in \"" + array.name + "\"";
  file.array = array.name;
  if (options.time) {
    if (array.times.empty()) {
      throw Error(name + ": \"" + array.name + "\" has no steps in time; leave the time out");
    }
    if (options.component) throw Error(name + ": give a time or a component, not both");
    file.step = static_cast<int>(nearest_step(array.times, options.time));
  }
  file.read = [path, &module, array](ComponentRange range) {
    return read_values(path, module, array, range);
  };
  return file;
}

std::vector<VolumeArray> list_arrays(const std::filesystem::path& path, const Module& module) {
  const GridContents contents = contents_of(path, module);
  std::vector<VolumeArray> list;
  for (const GridArray& array : contents.arrays) {
    VolumeArray about;
    about.name = array.name;
    about.shown = list.empty();
    about.dimensions.assign(array.sides.begin(), array.sides.end());
    for (int c = 0; c < array.components; ++c) {
      const VolumeData values = read_values(path, module, array, {c, 1}).front();
      about.type = type_name(values);
      about.components.push_back(component_statistics(values, 1).front());
    }
    list.push_back(std::move(about));
  }
  return list;
}

}  // namespace

VolumeFile open_hdf5(const std::filesystem::path& path, const ReadOptions& options) {
  return open_grid(path, options, hdf5);
}

VolumeFile open_net_cdf(const std::filesystem::path& path, const ReadOptions& options) {
  check_input_file(path);
  check_net_cdf_size(path);
  return open_grid(path, options, net_cdf);
}

std::vector<VolumeArray> list_hdf5_arrays(const std::filesystem::path& path) {
  return list_arrays(path, hdf5);
}

std::vector<VolumeArray> list_net_cdf_arrays(const std::filesystem::path& path) {
  check_input_file(path);
  check_net_cdf_size(path);
  return list_arrays(path, net_cdf);
}

}  // namespace pellucid
