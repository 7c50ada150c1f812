// SPDX-License-Identifier: Apache-2.0
#include <netcdf.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "axes/positions_beside.h"
#include "axes/variable_notes.h"
#include "grid_modules/grid_module.h"
#include "grid_modules/hand_over.h"
#include "netcdf_variables.h"
#include "pellucid/scene/error.h"
#include "volumes/stored_numbers.h"

namespace pellucid {

namespace {

/// A variable that is a volume, and how it is read.
struct NetCdfVolume {
  NetCdfVariable variable;
  std::vector<NetCdfAxis> axes;
  VolumeAxes volume;
  ValueMeaning meaning;
  std::vector<std::string> notes;
};

/// Takes the axes by their places: the last three are z, y, x.
std::optional<VolumeAxes> axes_by_place(const NetCdfVariable& variable,
                                        std::vector<std::string>& notes) {
  std::size_t begin = 0;
  const std::size_t end = variable.sides.size();
  while (end - begin > 3 && variable.sides[begin] == 1) ++begin;
  if (end - begin < 3 || end - begin > 4) return std::nullopt;
  ArrayAxes axes;
  axes.space = {end - 1, end - 2, end - 3};
  if (end - begin == 3) return volume_axes(axes, variable.sides);
  axes.components = begin;
  VolumeAxes volume = volume_axes(axes, variable.sides);
  const std::string name = net_cdf_axis(variable, begin);
  volume.holds = std::to_string(variable.sides[begin]) + " components (axis " + name + ")";
  notes.push_back("nothing says what the axes of \"" + variable.name + "\" are; the first (" +
                  name + ") is taken for components, the last for x");
  return volume;
}

/// Returns nothing where the variable is no volume. Throws Error that says why, where that is of
/// interest.
std::optional<NetCdfVolume> volume_of(const NetCdfVariable& variable) {
  const auto type = stored_type(variable);
  if (variable.sides.size() < 3 || !type) return std::nullopt;
  for (std::size_t a = 0; a < variable.sides.size(); ++a) {
    if (variable.sides[a] > std::numeric_limits<int>::max()) return std::nullopt;
    if (variable.sides[a] == 0) {
      throw Error("an array whose axis " + net_cdf_axis(variable, a) + " has no entries");
    }
  }
  NetCdfVolume found{variable, net_cdf_axes(variable), {}, {}, {}};
  std::vector<AxisText> texts;
  for (const NetCdfAxis& axis : found.axes) texts.push_back(axis.text);
  std::optional<VolumeAxes> volume = volume_axes(texts, variable.sides);
  if (!volume) volume = axes_by_place(variable, found.notes);
  if (!volume) return std::nullopt;
  found.volume = *std::move(volume);
  for (const std::string& note : found.volume.notes) {
    found.notes.push_back("\"" + variable.name + "\": " + note);
  }
  found.meaning = meaning_of(variable, found.notes);
  return found;
}

bool is_wide(const NetCdfVariable& variable) {
  return variable.type == NC_INT64 || variable.type == NC_UINT64;
}

/// Returns whether whole numbers of 64 bits get the smallest type that holds them, or double.
bool may_be_whole(const NetCdfVolume& volume) {
  return is_wide(volume.variable) && !volume.meaning.is_scaled() &&
         volume.meaning.missing.empty() && !volume.meaning.has_range();
}

GridArray describe(const NetCdfVolume& of) {
  const NetCdfVariable& variable = of.variable;
  const std::string stored = *stored_type(variable);
  GridArray array;
  array.name = variable.name;
  array.type = of.meaning.is_scaled() ? type_with_meaning(stored) : stored;
  if (of.meaning.may_miss()) array.type_with_missing = type_with_meaning(array.type);
  // The type of values must not depend on which of them are read.
  array.reads_parts = !may_be_whole(of) &&
                      (array.type_with_missing.empty() || array.type_with_missing == array.type);
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t axis = of.volume.space[a];
    array.sides[a] = variable.sides[axis];
    array.positions[a] = positions_of(of.axes[axis], variable.sides[axis]);
  }
  array.components = of.volume.component_count(variable.sides);
  array.holds = of.volume.holds;
  if (of.volume.time) {
    const std::int64_t steps = variable.sides[*of.volume.time];
    AxisPositions along = positions_of(of.axes[*of.volume.time], steps);
    array.times = std::move(along.numbers);
    // Steps without times are counted.
    if (!array.times.empty()) {
      array.times_unit = std::move(along.units);
    } else {
      for (std::int64_t t = 0; t < steps; ++t) array.times.push_back(static_cast<double>(t));
    }
    array.components_of_a_step = of.volume.components_of_a_step(variable.sides);
  }
  array.notes = of.notes;
  std::array<std::string, 3> space;
  for (std::size_t a = 0; a < 3; ++a) space[a] = of.axes[of.volume.space[a]].text.name;
  const FindVariable find = [&](const std::string& name) -> std::optional<NamedVariable> {
    const auto found = net_cdf_variable(variable.group, name);
    if (!found) return std::nullopt;
    NamedVariable named{found->attributes, {}};
    for (std::size_t a = 0; a < found->axes.size(); ++a) {
      named.axes.push_back(net_cdf_axis(*found, a));
    }
    return named;
  };
  for (std::string& note : notes_on_unread(variable.attributes, variable.name)) {
    array.notes.push_back(std::move(note));
  }
  for (std::string& note : variable_notes(variable.name, variable.attributes, space, find)) {
    array.notes.push_back(std::move(note));
  }
  return array;
}

/// The part of a variable that is read.
struct Box {
  std::vector<std::size_t> start, count;
  std::array<int, 3> sides{};
  std::size_t points = 0;
};

/// Reads values in the order of the file, as they are stored.
void read_box(const NetCdfVariable& variable, const Box& box, std::byte* to) {
  const bool as_double = is_wide(variable) || variable.type == NC_DOUBLE;
  const int status =
      as_double ? nc_get_vara_double(variable.group, variable.id, box.start.data(),
                                     box.count.data(), reinterpret_cast<double*>(to))
                : nc_get_vara(variable.group, variable.id, box.start.data(), box.count.data(), to);
  check_net_cdf(status, "the values of \"" + variable.name + "\"");
}

/// Returns whole numbers of 64 bits in the smallest type that holds all of them. Nothing where one
/// of them is the default fill.
template <class Number>
std::optional<VolumeData> read_whole_numbers(const NetCdfVolume& of, const Box& box,
                                             std::string& note) {
  const NetCdfVariable& variable = of.variable;
  std::vector<Number> numbers(box.points);
  read_permuted(std::as_writable_bytes(std::span(numbers)), sizeof(Number), box.sides,
                of.volume.space, [&](std::byte* to) {
                  check_net_cdf(nc_get_vara(variable.group, variable.id, box.start.data(),
                                            box.count.data(), to),
                                "the values of \"" + variable.name + "\"");
                });
  const auto is_fill = [&](Number number) {
    return of.meaning.default_fill && static_cast<double>(number) == *of.meaning.default_fill;
  };
  if (std::ranges::any_of(numbers, is_fill)) return std::nullopt;
  WholeNumbers kept([&](const std::string& type) { return make_volume_data(type, box.points); });
  kept.add(std::span<const Number>(numbers));
  if (kept.rounding().count > 0) note = kept.rounding().text(box.points);
  return kept.take();
}

VolumeData read_component(const NetCdfVolume& of, const Box& box, DefaultFills& fills,
                          std::string& note) {
  if (may_be_whole(of)) {
    auto whole = of.variable.type == NC_INT64 ? read_whole_numbers<std::int64_t>(of, box, note)
                                              : read_whole_numbers<std::uint64_t>(of, box, note);
    if (whole) return *std::move(whole);
  }
  VolumeData data = make_volume_data(*stored_type(of.variable), box.points);
  std::visit(
      [&](auto& values) {
        const std::span<std::byte> to = std::as_writable_bytes(values.writable());
        read_permuted(to, to.size() / box.points, box.sides, of.volume.space,
                      [&](std::byte* stored) { read_box(of.variable, box, stored); });
      },
      data);
  const DefaultFills found = apply_meaning(std::span(&data, 1), of.meaning);
  fills.number = found.number;
  fills.count += found.count;
  return data;
}

/// Chunks of bytes, and how many of them hold the fill byte alone: those that were never written.
struct FilledChunks {
  std::size_t filled = 0, all = 0;

  /// Counts the chunks of a part, x fastest. A variable that is not stored in chunks is one.
  void count(const NetCdfVolume& of, const Box& box, std::span<const std::uint8_t> values,
             std::uint8_t fill) {
    const NetCdfVariable& variable = of.variable;
    int storage = NC_CONTIGUOUS;
    std::vector<std::size_t> sides(variable.sides.size(), 0);
    const int status = nc_inq_var_chunking(variable.group, variable.id, &storage, sides.data());
    std::array<std::vector<std::size_t>, 3> cuts;  // where chunks begin, and the end
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t axis = of.volume.space[a], begin = box.start[axis];
      const std::size_t end = begin + box.count[axis];
      const bool is_cut = status == NC_NOERR && storage == NC_CHUNKED && sides[axis] > 0;
      for (std::size_t at = begin; at < end;) {
        cuts[a].push_back(at - begin);
        at = is_cut ? std::min(end, (at / sides[axis] + 1) * sides[axis]) : end;
      }
      cuts[a].push_back(end - begin);
    }
    const auto width = static_cast<std::size_t>(box.sides[0]);
    const auto height = static_cast<std::size_t>(box.sides[1]);
    for (std::size_t k = 0; k + 1 < cuts[2].size(); ++k) {
      for (std::size_t j = 0; j + 1 < cuts[1].size(); ++j) {
        for (std::size_t i = 0; i + 1 < cuts[0].size(); ++i) {
          bool is_filled = true;
          for (std::size_t z = cuts[2][k]; z < cuts[2][k + 1] && is_filled; ++z) {
            for (std::size_t y = cuts[1][j]; y < cuts[1][j + 1] && is_filled; ++y) {
              const auto row = values.subspan((z * height + y) * width + cuts[0][i],
                                              cuts[0][i + 1] - cuts[0][i]);
              is_filled = std::ranges::all_of(row, [&](std::uint8_t v) { return v == fill; });
            }
          }
          ++all;
          filled += is_filled ? 1 : 0;
        }
      }
    }
  }

  std::string note(const NetCdfVariable& variable, std::uint8_t fill) const {
    if (filled == 0) return {};
    const int shown = variable.type == NC_BYTE ? static_cast<std::int8_t>(fill) : fill;
    return std::to_string(filled) + " of " + std::to_string(all) +
           (all == 1 ? " chunk of \"" : " chunks of \"") + variable.name + "\" hold nothing but " +
           std::to_string(shown) +
           ", which NetCDF writes where nothing was written; it is shown as a value";
  }
};

/// Returns notes on variables beside one that may say its positions. Coordinates are others, which
/// the conventions name.
std::vector<std::string> notes_on_others(const NetCdfVariable& of,
                                         const std::vector<NetCdfVariable>& variables) {
  std::vector<ArrayBeside> arrays;
  for (const NetCdfVariable& variable : variables) {
    const bool has_own_axes = std::ranges::none_of(
        variable.axes, [&](int axis) { return std::ranges::find(of.axes, axis) != of.axes.end(); });
    if (variable.group != of.group || !has_own_axes) continue;
    arrays.push_back({variable.name.substr(variable.name.rfind('/') + 1), variable.sides});
  }
  std::vector<std::string> notes;
  const PositionsBeside beside = positions_beside(arrays, of.sides, {{}, {}, true, true});
  for (const std::string& note : beside.notes) notes.push_back("\"" + of.name + "\": " + note);
  return notes;
}

}  // namespace

void list_grids(const std::filesystem::path& path, const AxisLetters&, GridContents& contents) {
  const NetCdfFile file(path);
  const std::vector<NetCdfVariable> variables = net_cdf_variables(file.id());
  VariableHelpers helpers;
  for (const NetCdfVariable& variable : variables) helpers.add(variable.name, variable.attributes);
  std::vector<GridArray> auxiliary;
  for (const NetCdfVariable& variable : variables) {
    try {
      if (helpers.is_bounds(variable.name) && variable.sides.size() > 2) {
        throw Error("bounds of cells, no array of values");
      }
      if (const auto volume = volume_of(variable)) {
        // Arrays of data come first: the first one is shown where none is chosen.
        GridArray array = describe(*volume);
        std::ranges::move(notes_on_others(variable, variables), std::back_inserter(array.notes));
        (helpers.is_auxiliary(variable.name) ? auxiliary : contents.arrays)
            .push_back(std::move(array));
      } else {
        contents.others.push_back({variable.name, {}});
      }
    } catch (const Error& error) {
      contents.others.push_back({variable.name, error.what()});
    }
  }
  std::ranges::move(auxiliary, std::back_inserter(contents.arrays));
}

void read_grid(const std::filesystem::path& path, const std::string& name, const AxisLetters&,
               ComponentRange range, GridValues& values) {
  const NetCdfFile file(path);
  const std::vector<NetCdfVariable> variables = net_cdf_variables(file.id());
  const auto variable =
      std::ranges::find_if(variables, [&](const NetCdfVariable& v) { return v.name == name; });
  const auto of = variable == variables.end() ? std::nullopt : volume_of(*variable);
  if (!of) throw Error("the file was changed while it was read");
  Box box;
  box.start.assign(variable->sides.size(), 0);
  box.count.assign(variable->sides.size(), 1);
  std::array<std::int64_t, 3> sides{};
  for (std::size_t a = 0; a < 3; ++a) sides[a] = variable->sides[of->volume.space[a]];
  const GridPart part = wanted_part(sides, range);
  box.sides = part.box.count;
  box.points = value_count(part.box);
  for (std::size_t a = 0; a < 3; ++a) {
    box.start[of->volume.space[a]] = static_cast<std::size_t>(part.box.first[a]);
    box.count[of->volume.space[a]] = static_cast<std::size_t>(part.box.count[a]);
  }
  DefaultFills fills;
  FilledChunks chunks;
  const std::optional<std::uint8_t> byte = unmarked_fill(*variable);
  for (int c = range.first; c < range.first + range.number; ++c) {
    of->volume.set_component(std::span(box.start), variable->sides, c);
    const std::span<const std::byte> all =
        hand_over(read_component(*of, box, fills, values.note), values);
    if (!byte || all.size() != box.points) continue;
    chunks.count(*of, box, {reinterpret_cast<const std::uint8_t*>(all.data()), all.size()}, *byte);
  }
  if (const std::string note = note_of(fills, name); !note.empty()) values.note = note;
  if (byte && chunks.filled > 0) values.note = chunks.note(*variable, *byte);
}

}  // namespace pellucid
