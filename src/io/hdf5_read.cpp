// SPDX-License-Identifier: Apache-2.0
#include <hdf5.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "grid_module.h"
#include "hdf5_parts.h"
#include "pellucid/scene/error.h"

namespace pellucid {

namespace {

/// A dataset's axes, and which of them are those of the volume.
struct Axes {
  std::vector<hsize_t> sides;
  std::size_t first = 0;                  ///< of z, y, x, which follow each other
  std::optional<std::size_t> components;  ///< the one beside them
};

/// Nothing where there are not three of them, or four.
std::optional<Axes> axes_of(hid_t space) {
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 3) return std::nullopt;
  Axes axes;
  axes.sides.resize(static_cast<std::size_t>(rank));
  if (H5Sget_simple_extent_dims(space, axes.sides.data(), nullptr) != rank) return std::nullopt;
  std::size_t begin = 0, end = axes.sides.size();
  while (end - begin > 3 && axes.sides[begin] == 1) ++begin;
  while (end - begin > 3 && axes.sides[end - 1] == 1) --end;
  if (end - begin > 4) return std::nullopt;
  axes.first = begin;
  if (end - begin == 4) {
    // Colors and vectors stand behind, steps in front.
    constexpr hsize_t most_behind = 4;
    const bool behind = axes.sides[end - 1] <= most_behind;
    axes.components = behind ? end - 1 : begin;
    if (!behind) ++axes.first;
  }
  constexpr hsize_t most = std::numeric_limits<int>::max();
  if (std::ranges::any_of(axes.sides, [](hsize_t side) { return side < 1 || side > most; })) {
    return std::nullopt;
  }
  return axes;
}

std::optional<GridArray> describe(hid_t dataset, const std::string& name) {
  const Id space(H5Dget_space(dataset), H5Sclose, "the axes of a dataset");
  const Id type(H5Dget_type(dataset), H5Tclose, "the type of a dataset");
  const auto axes = axes_of(space.get());
  const auto kept = type_of(type.get());
  if (!axes) return std::nullopt;
  check_kind(dataset, type.get());
  if (!kept) return std::nullopt;
  GridArray array;
  array.name = name;
  array.type = *kept;
  for (std::size_t a = 0; a < 3; ++a) {
    array.sides[2 - a] = static_cast<std::int64_t>(axes->sides[axes->first + a]);
  }
  if (axes->components) {
    const auto count = static_cast<int>(axes->sides[*axes->components]);
    array.components = count;
    array.holds =
        std::to_string(count) + " components (axis " + std::to_string(*axes->components) + ")";
  }
  return array;
}

herr_t take_name(hid_t, const char* name, const H5O_info_t* about, void* names) {
  if (about->type == H5O_TYPE_DATASET) {
    static_cast<std::vector<std::string>*>(names)->push_back("/" + std::string(name));
  }
  return 0;
}

}  // namespace

void list_grids(const std::filesystem::path& path, GridContents& contents) {
  const Id file(open_file(path), H5Fclose, "the file");
  std::vector<std::string> names;
  if (H5Ovisit(file.get(), H5_INDEX_NAME, H5_ITER_INC, take_name, &names) < 0) {
    throw Error("HDF5 cannot read its list of datasets; the file is damaged");
  }
  for (const std::string& name : names) {
    const Id dataset(H5Dopen2(file.get(), name.c_str(), H5P_DEFAULT), H5Dclose, name.c_str());
    try {
      if (auto array = describe(dataset.get(), name)) {
        contents.arrays.push_back(*std::move(array));
      } else {
        contents.others.push_back({name, {}});
      }
    } catch (const Error& error) {
      contents.others.push_back({name, error.what()});
    }
  }
}

void read_grid(const std::filesystem::path& path, const std::string& name, ComponentRange range,
               GridValues& values) {
  const Id file(open_file(path), H5Fclose, "the file");
  const Id dataset(H5Dopen2(file.get(), name.c_str(), H5P_DEFAULT), H5Dclose, name.c_str());
  const Id space(H5Dget_space(dataset.get()), H5Sclose, "the axes of a dataset");
  const auto axes = axes_of(space.get());
  const auto array = describe(dataset.get(), name);
  if (!axes || !array) throw Error("the file was changed while it was read");
  std::vector<hsize_t> start(axes->sides.size(), 0), count(axes->sides.size(), 1);
  hsize_t points = 1;
  for (std::size_t a = axes->first; a < axes->first + 3; ++a) {
    count[a] = axes->sides[a];
    points *= count[a];
  }
  const Id memory(H5Screate_simple(1, &points, nullptr), H5Sclose, "the axes of a dataset");
  for (int c = range.first; c < range.first + range.number; ++c) {
    if (axes->components) start[*axes->components] = static_cast<hsize_t>(c);
    const std::span<std::byte> to = values.next(array->type);
    if (to.size() != points * H5Tget_size(memory_type(array->type))) {
      throw Error("the file was changed while it was read");
    }
    const bool done = H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr,
                                          count.data(), nullptr) >= 0 &&
                      H5Dread(dataset.get(), memory_type(array->type), memory.get(), space.get(),
                              H5P_DEFAULT, to.data()) >= 0;
    if (!done) {
      throw Error("HDF5 cannot read the values of \"" + name +
                  "\"; the file is cut off or damaged, or compressed in a way that it lacks");
    }
  }
}

}  // namespace pellucid
