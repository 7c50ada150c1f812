// SPDX-License-Identifier: Apache-2.0
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "array_axes.h"
#include "grid_module.h"
#include "hdf5_parts.h"
#include "pellucid/scene/error.h"
#include "stored_numbers.h"

namespace pellucid {

namespace {

/// The sides of a dataset along its axes; nothing where they are fewer than three, or none can be.
std::optional<std::vector<std::int64_t>> shape_of(hid_t space) {
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 3) return std::nullopt;
  std::vector<hsize_t> sides(static_cast<std::size_t>(rank));
  if (H5Sget_simple_extent_dims(space, sides.data(), nullptr) != rank) return std::nullopt;
  constexpr hsize_t most = std::numeric_limits<int>::max();
  if (std::ranges::any_of(sides, [](hsize_t side) { return side < 1 || side > most; })) {
    return std::nullopt;
  }
  return std::vector<std::int64_t>(sides.begin(), sides.end());
}

/// Nothing where there are not three axes, or four. Throws Error for letters that do not fit.
std::optional<ArrayAxes> axes_of(const std::vector<std::int64_t>& shape,
                                 const AxisLetters& letters) {
  if (letters)
    return array_axes(shape, letters, "an array of shape (" + shape_text(shape) + "), which");
  try {
    return array_axes(shape, letters, {});
  } catch (const Error&) {
    return std::nullopt;
  }
}

struct Dataset {
  GridArray about;
  std::string type;  ///< of its values in memory
  std::vector<std::int64_t> shape;
  ArrayAxes axes;
};

std::optional<Dataset> describe(hid_t id, const std::string& name, const AxisLetters& letters) {
  const Id space(H5Dget_space(id), H5Sclose, "the axes of a dataset");
  const Id type(H5Dget_type(id), H5Tclose, "the type of a dataset");
  const auto shape = shape_of(space.get());
  const auto axes = shape ? axes_of(*shape, letters) : std::nullopt;
  const auto number = type_of(type.get());
  if (!axes) return std::nullopt;
  check_kind(id, type.get());
  if (!number) return std::nullopt;
  Dataset dataset{{}, *number, *shape, *axes};
  GridArray& array = dataset.about;
  array.name = name;
  array.type = is_stored_only(*number) ? "f64" : *number;
  // The type of whole numbers of 64 bits is that of the largest.
  array.reads_parts = !is_stored_only(*number);
  for (std::size_t a = 0; a < 3; ++a) array.sides[a] = (*shape)[axes->space[a]];
  if (axes->components) {
    const auto count = static_cast<int>((*shape)[*axes->components]);
    array.components = count;
    array.holds =
        std::to_string(count) + " components (axis " + std::to_string(*axes->components) + ")";
    if (!axes->guess.empty()) array.note = "\"" + name + "\": " + axes_note(*shape, *axes);
  }
  return dataset;
}

/// Reads values of a part of one component in the order of the file.
void read_component(hid_t id, const Dataset& dataset, int component, const IndexBox& part,
                    void* to) {
  const Id space(H5Dget_space(id), H5Sclose, "the axes of a dataset");
  std::vector<hsize_t> start(dataset.shape.size(), 0), count(dataset.shape.size(), 1);
  hsize_t points = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t axis = dataset.axes.space[a];
    start[axis] = static_cast<hsize_t>(part.first[a]);
    count[axis] = static_cast<hsize_t>(part.count[a]);
    points *= count[axis];
  }
  if (dataset.axes.components) start[*dataset.axes.components] = static_cast<hsize_t>(component);
  const Id memory(H5Screate_simple(1, &points, nullptr), H5Sclose, "the axes of a dataset");
  const bool done =
      H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(),
                          nullptr) >= 0 &&
      H5Dread(id, memory_type(dataset.type), memory.get(), space.get(), H5P_DEFAULT, to) >= 0;
  if (!done) throw unreadable_values(id, dataset.about.name);
}

/// In values, of x, y and z of a part in the order of the file, without the axis of components.
std::array<std::size_t, 3> strides_of(const Dataset& dataset, const IndexBox& part) {
  std::array<std::size_t, 3> strides{};
  for (std::size_t a = 0; a < 3; ++a) {
    strides[a] = 1;
    for (std::size_t b = 0; b < 3; ++b) {
      if (dataset.axes.space[b] > dataset.axes.space[a]) {
        strides[a] *= static_cast<std::size_t>(part.count[b]);
      }
    }
  }
  return strides;
}

/// Reads values of a part of one component, x fastest.
void read_ordered(hid_t id, const Dataset& dataset, int component, const IndexBox& part,
                  std::span<std::byte> to, std::size_t size) {
  if (std::ranges::is_sorted(dataset.axes.space, std::greater<>())) {
    read_component(id, dataset, component, part, to.data());
    return;
  }
  std::vector<std::byte> stored(to.size());
  read_component(id, dataset, component, part, stored.data());
  copy_permuted(stored.data(), to.data(), size, {part.count[0], part.count[1], part.count[2]},
                strides_of(dataset, part));
}

template <class Number>
void read_whole_numbers(hid_t id, const Dataset& dataset, const GridPart& part,
                        ComponentRange range, GridValues& values) {
  const std::size_t points = value_count(part.box);
  std::vector<WholeNumbers> components;
  std::vector<Number> numbers(points);
  Rounding rounding;
  for (int c = range.first; c < range.first + range.number; ++c) {
    read_ordered(id, dataset, c, part.box, std::as_writable_bytes(std::span(numbers)),
                 sizeof(Number));
    components.emplace_back(
        [&](const std::string& type) { return make_volume_data(type, points); });
    components.back().add(std::span<const Number>(numbers));
    rounding.merge(components.back().rounding());
  }
  unify(components);
  for (WholeNumbers& component : components) {
    const VolumeData kept = component.take();
    std::visit(
        [&](const auto& of_type) {
          const auto all = std::as_bytes(std::span(of_type.data(), of_type.size()));
          std::ranges::copy(all, values.next(component.type()).begin());
        },
        kept);
  }
  if (rounding.count > 0) values.note = rounding.text(points * components.size());
}

herr_t take_name(hid_t, const char* name, const H5O_info_t* about, void* names) {
  if (about->type == H5O_TYPE_DATASET) {
    static_cast<std::vector<std::string>*>(names)->push_back("/" + std::string(name));
  }
  return 0;
}

}  // namespace

void list_grids(const std::filesystem::path& path, const AxisLetters& axes,
                GridContents& contents) {
  const Id file(open_file(path), H5Fclose, "the file");
  std::vector<std::string> names;
  if (H5Ovisit(file.get(), H5_INDEX_NAME, H5_ITER_INC, take_name, &names) < 0) {
    throw Error("HDF5 cannot read its list of datasets; the file is damaged");
  }
  for (const std::string& name : names) {
    const Id dataset(H5Dopen2(file.get(), name.c_str(), H5P_DEFAULT), H5Dclose, name.c_str());
    try {
      if (auto found = describe(dataset.get(), name, axes)) {
        contents.arrays.push_back(std::move(found->about));
      } else {
        contents.others.push_back({name, {}});
      }
    } catch (const Error& error) {
      contents.others.push_back({name, error.what()});
    }
  }
}

void read_grid(const std::filesystem::path& path, const std::string& name, const AxisLetters& axes,
               ComponentRange range, GridValues& values) {
  const Id file(open_file(path), H5Fclose, "the file");
  const Id id(H5Dopen2(file.get(), name.c_str(), H5P_DEFAULT), H5Dclose, name.c_str());
  const auto dataset = describe(id.get(), name, axes);
  if (!dataset) throw Error("the file was changed while it was read");
  const GridPart part = wanted_part(dataset->about.sides, range);
  if (dataset->type == "i64") {
    return read_whole_numbers<std::int64_t>(id.get(), *dataset, part, range, values);
  }
  if (dataset->type == "u64") {
    return read_whole_numbers<std::uint64_t>(id.get(), *dataset, part, range, values);
  }
  const std::size_t size = H5Tget_size(memory_type(dataset->type));
  for (int c = range.first; c < range.first + range.number; ++c) {
    const std::span<std::byte> to = values.next(dataset->about.type);
    if (to.size() != value_count(part.box) * size)
      throw Error("the file was changed while it was read");
    read_ordered(id.get(), *dataset, c, part.box, to, size);
  }
}

}  // namespace pellucid
