// SPDX-License-Identifier: Apache-2.0
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "axes/array_axes.h"
#include "axes/value_meaning.h"
#include "axes/variable_notes.h"
#include "grid_modules/grid_module.h"
#include "grid_modules/hand_over.h"
#include "hdf5_attributes.h"
#include "hdf5_imaris.h"
#include "hdf5_parts.h"
#include "pellucid/scene/error.h"
#include "volumes/stored_numbers.h"

namespace pellucid {

namespace {

/// Returns the sides of a dataset along its axes; nothing where they are fewer than three, or none
/// can be.
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

/// Returns the axes by the letters given, by their meaning, or by their places. Nothing where they
/// are those of no volume. Throws Error for letters that do not fit, and for axes that are others.
std::optional<VolumeAxes> axes_of(const std::vector<std::int64_t>& shape, const Hdf5Axes& named,
                                  const AxisLetters& letters, GridArray& array) {
  std::optional<ArrayAxes> placed;
  if (letters) {
    placed = array_axes(shape, letters, "an array of shape (" + shape_text(shape) + "), which");
  } else {
    if (auto axes = volume_axes(named.texts, shape)) return axes;
    try {
      placed = array_axes(shape, letters, {});
    } catch (const Error&) {
      return std::nullopt;
    }
  }
  if (!placed->guess.empty()) {
    array.notes.push_back("\"" + array.name + "\": " + axes_note(shape, *placed));
  }
  return volume_axes(*placed, shape);
}

struct Dataset {
  GridArray about;
  std::string type;   ///< of its values in memory
  std::string meant;  ///< the same, or that with the other sign (_Unsigned)
  std::vector<std::int64_t> shape;
  VolumeAxes axes;
  ValueMeaning meaning;
  std::optional<double> fill;  ///< value that the file states for what was never written
};

/// Returns whether whole numbers of 64 bits get the smallest type that holds them, or double.
bool may_be_whole(const Dataset& dataset) {
  return is_stored_only(dataset.type) && !dataset.meaning.is_scaled() &&
         !dataset.meaning.may_miss();
}

/// Takes positions, and the meaning of axes that is a guess, from datasets beside this one. Returns
/// notes that begin with "its".
std::vector<std::string> place_by_arrays(hid_t id, const Hdf5Axes& named, bool is_said,
                                         Dataset& dataset) {
  const std::vector<ArrayBeside> arrays =
      hdf5_arrays_beside(id, dataset.about.name, dataset.shape, named);
  if (arrays.empty()) return {};
  VolumeAxes& axes = dataset.axes;
  KnownAxes known{axes.space, {}, is_said, false};
  if (axes.components.size() == 1) known.components = axes.components.front();
  for (std::size_t a = 0; a < dataset.shape.size(); ++a) {
    known.is_said = known.is_said || !named.texts[a].name.empty();
  }
  for (const std::size_t axis : axes.space) {
    known.is_placed = known.is_placed || !named.positions[axis].numbers.empty();
  }
  PositionsBeside found = positions_beside(arrays, dataset.shape, known);
  axes.space = found.space;
  dataset.about.positions = std::move(found.positions);
  dataset.about.placement = found.placement;
  if (!found.times.empty() && !axes.time) {
    axes.time = axes.components.front();
    dataset.about.times = std::move(found.times);
  }
  return std::move(found.notes);
}

/// Adds positions and steps in time.
void place(const Hdf5Axes& named, Dataset& dataset) {
  GridArray& array = dataset.about;
  for (std::size_t a = 0; a < 3; ++a) {
    const AxisPositions& own = named.positions[dataset.axes.space[a]];
    if (!own.numbers.empty() || array.positions[a].numbers.empty()) array.positions[a] = own;
  }
  if (!dataset.axes.time) return;
  if (array.times.empty()) {
    const AxisPositions& along = named.positions[*dataset.axes.time];
    array.times = along.numbers;
    if (!array.times.empty()) array.times_unit = along.units;
  }
  for (std::int64_t t = 0; array.times.empty() && t < dataset.shape[*dataset.axes.time]; ++t) {
    array.times.push_back(static_cast<double>(t));
  }
  array.components_of_a_step = dataset.axes.components_of_a_step(dataset.shape);
}

/// Returns notes on what the groups say that a dataset is in, from the root on.
std::vector<std::string> notes_on_groups(hid_t dataset, const std::string& name) {
  std::vector<std::string> notes;
  const Id file(H5Iget_file_id(dataset), H5Fclose, "the file");
  for (std::size_t end = 0; end != std::string::npos; end = name.find('/', end + 1)) {
    const std::string group = end == 0 ? "/" : name.substr(0, end);
    const hid_t opened = H5Gopen2(file.get(), group.c_str(), H5P_DEFAULT);
    if (opened < 0) break;
    const Id id(opened, H5Gclose, "a group");
    std::string note = note_on_group(hdf5_attributes(id.get()), group, name);
    if (!note.empty()) notes.push_back(std::move(note));
  }
  return notes;
}

std::optional<Dataset> describe(hid_t id, const std::string& name, const AxisLetters& letters) {
  const Id space(H5Dget_space(id), H5Sclose, "the axes of a dataset");
  const Id type(H5Dget_type(id), H5Tclose, "the type of a dataset");
  const auto shape = shape_of(space.get());
  const auto number = type_of(type.get());
  if (!shape) return std::nullopt;
  Dataset dataset;
  dataset.about.name = name;
  const VariableAttributes attributes = hdf5_attributes(id);
  const Hdf5Axes named = hdf5_axes(id, *shape, attributes, name);
  auto axes = axes_of(*shape, named, letters, dataset.about);
  if (!axes) return std::nullopt;
  check_kind(id, type.get());
  if (!number) return std::nullopt;
  dataset.type = *number;
  dataset.meant = hdf5_meant_type(*number, attributes);
  dataset.shape = *shape;
  dataset.axes = *std::move(axes);
  GridArray& array = dataset.about;
  dataset.meaning = value_meaning(attributes, dataset.meant, name, array.notes);
  const std::string stored = is_stored_only(*number) ? "f64" : dataset.meant;
  array.type = dataset.meaning.is_scaled() ? type_with_meaning(stored) : stored;
  if (dataset.meaning.may_miss()) array.type_with_missing = type_with_meaning(array.type);
  // The type of values must not depend on which of them are read.
  array.reads_parts = !may_be_whole(dataset) &&
                      (array.type_with_missing.empty() || array.type_with_missing == array.type);
  const std::vector<std::string> beside = place_by_arrays(id, named, letters.has_value(), dataset);
  for (std::size_t a = 0; a < 3; ++a) array.sides[a] = (*shape)[dataset.axes.space[a]];
  array.components = dataset.axes.component_count(*shape);
  array.holds = dataset.axes.holds;
  place(named, dataset);
  const auto tell = [&](const std::vector<std::string>& notes, const std::string& before) {
    for (const std::string& note : notes) array.notes.push_back(before + note);
  };
  tell(named.notes, {});
  tell(beside, "\"" + name + "\": ");
  tell(dataset.axes.notes, "\"" + name + "\": ");
  tell(notes_on_unread(attributes, name), {});
  tell(notes_on_groups(id, name), {});
  const Hdf5Fill fill = hdf5_fill(id, *shape, name);
  dataset.fill = fill.value;
  if (!fill.note.empty()) array.notes.push_back(fill.note);
  return dataset;
}

/// Reads values of a part of one component in the order of the file.
void read_component(hid_t id, const Dataset& dataset, int component, const IndexBox& part,
                    const std::string& type, void* to) {
  const Id space(H5Dget_space(id), H5Sclose, "the axes of a dataset");
  std::vector<hsize_t> start(dataset.shape.size(), 0), count(dataset.shape.size(), 1);
  hsize_t points = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t axis = dataset.axes.space[a];
    start[axis] = static_cast<hsize_t>(part.first[a]);
    count[axis] = static_cast<hsize_t>(part.count[a]);
    points *= count[axis];
  }
  dataset.axes.set_component(std::span(start), dataset.shape, component);
  const Id memory(H5Screate_simple(1, &points, nullptr), H5Sclose, "the axes of a dataset");
  const bool done = H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr,
                                        count.data(), nullptr) >= 0 &&
                    H5Dread(id, memory_type(type), memory.get(), space.get(), H5P_DEFAULT, to) >= 0;
  if (!done) throw unreadable_values(id, dataset.about.name);
}

/// Reads values of a part of one component in this type, x fastest.
void read_ordered(hid_t id, const Dataset& dataset, int component, const IndexBox& part,
                  const std::string& type, std::span<std::byte> to) {
  read_permuted(
      to, H5Tget_size(memory_type(type)), part.count, dataset.axes.space,
      [&](std::byte* stored) { read_component(id, dataset, component, part, type, stored); });
}

template <class Number>
void read_whole_numbers(hid_t id, const Dataset& dataset, const GridPart& part,
                        ComponentRange range, GridValues& values) {
  const std::size_t points = value_count(part.box);
  std::vector<WholeNumbers> components;
  std::vector<Number> numbers(points);
  Rounding rounding;
  for (int c = range.first; c < range.first + range.number; ++c) {
    read_ordered(id, dataset, c, part.box, dataset.type,
                 std::as_writable_bytes(std::span(numbers)));
    components.emplace_back(
        [&](const std::string& type) { return make_volume_data(type, points); });
    components.back().add(std::span<const Number>(numbers));
    rounding.merge(components.back().rounding());
  }
  unify(components);
  for (WholeNumbers& component : components) hand_over(component.take(), values);
  if (rounding.count > 0) values.note = rounding.text(points * components.size());
}

/// Counts values that are the fill value and no missing ones.
std::size_t count_fills(const VolumeData& data, const Dataset& dataset) {
  if (!dataset.fill ||
      std::ranges::find(dataset.meaning.missing, *dataset.fill) != dataset.meaning.missing.end()) {
    return 0;
  }
  return std::visit(
      [&](const auto& values) {
        return static_cast<std::size_t>(std::count_if(values.begin(), values.end(), [&](auto v) {
          return static_cast<double>(v) == *dataset.fill;
        }));
      },
      data);
}

void read_values(hid_t id, const Dataset& dataset, const GridPart& part, ComponentRange range,
                 GridValues& values) {
  const bool is_wide = is_stored_only(dataset.type);
  const std::string memory = is_wide ? "f64" : dataset.type;
  const std::size_t points = value_count(part.box);
  std::size_t fills = 0;
  for (int c = range.first; c < range.first + range.number; ++c) {
    VolumeData data = make_volume_data(is_wide ? "f64" : dataset.meant, points);
    std::visit(
        [&](auto& numbers) {
          read_ordered(id, dataset, c, part.box, memory,
                       std::as_writable_bytes(numbers.writable()));
        },
        data);
    fills += count_fills(data, dataset);
    apply_meaning(std::span(&data, 1), dataset.meaning);
    hand_over(std::move(data), values);
  }
  if (fills > 0) {
    values.note = std::to_string(fills) + " values of \"" + dataset.about.name +
                  "\" are the fill value of the dataset; they are shown as any other";
  }
}

herr_t take_name(hid_t, const char* name, const H5O_info_t* about, void* names) {
  if (about->type == H5O_TYPE_DATASET) {
    static_cast<std::vector<std::string>*>(names)->push_back("/" + std::string(name));
  }
  return 0;
}

/// Takes a link for HDF5, through which no exception may pass.
herr_t take_link(hid_t group, const char* name, const H5L_info_t* about, void* to) noexcept {
  if (about->type != H5L_TYPE_EXTERNAL) return 0;
  std::vector<char> value(about->u.val_size);
  const char *file = nullptr, *object = nullptr;
  if (H5Lget_val(group, name, value.data(), value.size(), H5P_DEFAULT) < 0 ||
      H5Lunpack_elink_val(value.data(), value.size(), nullptr, &file, &object) < 0) {
    return 0;
  }
  static_cast<GridContents*>(to)->others.push_back(
      {"/" + std::string(name), "a link to \"" + std::string(object).substr(0, 200) + "\" of \"" +
                                    std::string(file).substr(0, 200) +
                                    "\", which is not followed; give that file"});
  return 0;
}

}  // namespace

void list_grids(const std::filesystem::path& path, const AxisLetters& axes,
                GridContents& contents) {
  const Id file(open_file(path), H5Fclose, "the file");
  if (is_imaris(file.get())) {
    if (axes) throw Error("is of Imaris, which says what its axes are; leave the axes out");
    return list_imaris(file.get(), contents);
  }
  std::vector<std::string> names;
  if (H5Ovisit(file.get(), H5_INDEX_NAME, H5_ITER_INC, take_name, &names) < 0) {
    throw Error("HDF5 cannot read its list of datasets; the file is damaged");
  }
  H5Lvisit(file.get(), H5_INDEX_NAME, H5_ITER_INC, take_link, &contents);
  VariableHelpers helpers;
  for (const std::string& name : names) {
    const Id dataset(H5Dopen2(file.get(), name.c_str(), H5P_DEFAULT), H5Dclose, name.c_str());
    try {
      helpers.add(name.substr(1), hdf5_attributes(dataset.get()));
    } catch (const Error&) {
      continue;  // is told below
    }
  }
  std::vector<GridArray> auxiliary;
  for (const std::string& name : names) {
    const Id dataset(H5Dopen2(file.get(), name.c_str(), H5P_DEFAULT), H5Dclose, name.c_str());
    try {
      if (auto found = describe(dataset.get(), name, axes)) {
        if (helpers.is_bounds(name.substr(1))) throw Error("bounds of cells, no array of values");
        // Arrays of data come first: the first one is shown where none is chosen.
        const bool is_other = helpers.is_auxiliary(name.substr(1));
        (is_other ? auxiliary : contents.arrays).push_back(std::move(found->about));
      } else {
        contents.others.push_back({name, {}});
      }
    } catch (const Error& error) {
      contents.others.push_back({name, error.what()});
    }
  }
  std::ranges::move(auxiliary, std::back_inserter(contents.arrays));
}

void read_grid(const std::filesystem::path& path, const std::string& name, const AxisLetters& axes,
               ComponentRange range, GridValues& values) {
  const Id file(open_file(path), H5Fclose, "the file");
  if (is_imaris(file.get())) return read_imaris(file.get(), name, range, values);
  const Id id(H5Dopen2(file.get(), name.c_str(), H5P_DEFAULT), H5Dclose, name.c_str());
  const auto dataset = describe(id.get(), name, axes);
  if (!dataset) throw Error("the file was changed while it was read");
  const GridPart part = wanted_part(dataset->about.sides, range);
  if (!may_be_whole(*dataset)) return read_values(id.get(), *dataset, part, range, values);
  if (dataset->type == "i64") {
    return read_whole_numbers<std::int64_t>(id.get(), *dataset, part, range, values);
  }
  read_whole_numbers<std::uint64_t>(id.get(), *dataset, part, range, values);
}

}  // namespace pellucid
