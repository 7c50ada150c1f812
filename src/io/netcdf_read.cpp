// SPDX-License-Identifier: Apache-2.0
#include <netcdf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "grid_module.h"
#include "netcdf_variables.h"
#include "pellucid/scene/error.h"
#include "stored_numbers.h"

namespace pellucid {

namespace {

/// Stored numbers of up to 16 bits fit float after scaling to its own rounding.
bool fits_float(const std::string& type) {
  return type == "f32" || type.ends_with("8") || type.ends_with("16");
}

std::string kept_type(const NetCdfVariable& variable) {
  const std::string type = *stored_type(variable);
  if (meaning_of(variable).is_plain()) return type;
  return fits_float(type) ? "f32" : "f64";
}

/// Where z, y, x stand, which follow each other, and the axis in front of them.
struct Axes {
  std::size_t first = 0;
  std::optional<std::size_t> components;
};

std::optional<Axes> axes_of(const NetCdfVariable& variable) {
  std::size_t begin = 0, end = variable.sides.size();
  constexpr std::size_t most = std::numeric_limits<int>::max();
  for (const std::size_t side : variable.sides) {
    if (side < 1 || side > most) return std::nullopt;
  }
  while (end - begin > 3 && variable.sides[begin] == 1) ++begin;
  if (end - begin < 3 || end - begin > 4) return std::nullopt;
  if (end - begin == 3 && is_time_axis(variable, begin)) {
    throw Error("an array whose axis " + net_cdf_axis(variable, begin) +
                " is time and not z: images, no volume; save it with an axis of depth");
  }
  return end - begin == 3 ? Axes{begin, std::nullopt} : Axes{begin + 1, begin};
}

/// Whether the type of the values does not depend on which of them are read.
bool has_one_type(const NetCdfVariable& variable, const GridArray& array) {
  if (variable.type == NC_INT64 || variable.type == NC_UINT64) {
    const NetCdfMeaning meaning = meaning_of(variable);
    return !meaning.is_plain() || !meaning.missing.empty();
  }
  return array.type_with_missing.empty() || array.type_with_missing == array.type;
}

std::optional<GridArray> describe(const NetCdfVariable& variable) {
  const std::optional<Axes> axes = axes_of(variable);
  if (!axes || !stored_type(variable)) return std::nullopt;
  GridArray array;
  array.name = variable.name;
  array.type = kept_type(variable);
  if (!meaning_of(variable).missing.empty())
    array.type_with_missing = fits_float(array.type) ? "f32" : "f64";
  array.reads_parts = has_one_type(variable, array);
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t axis = axes->first + 2 - a;
    array.sides[a] = static_cast<std::int64_t>(variable.sides[axis]);
    NetCdfPositions positions = positions_of(variable, axis);
    array.positions[a] = std::move(positions.numbers);
    array.rounding[a] = positions.rounding;
  }
  if (axes->components) {
    array.components = static_cast<int>(variable.sides[*axes->components]);
    array.times = positions_of(variable, *axes->components).numbers;
    array.holds = std::to_string(array.components) + " steps (axis " +
                  net_cdf_axis(variable, *axes->components) + ")";
  }
  return array;
}

/// Whole numbers of 64 bits in the smallest type that holds all of them.
template <class Number>
VolumeData read_whole_numbers(const NetCdfVariable& variable, const std::vector<std::size_t>& start,
                              const std::vector<std::size_t>& count, std::size_t points,
                              std::string& note) {
  std::vector<Number> numbers(points);
  check_net_cdf(
      nc_get_vara(variable.group, variable.id, start.data(), count.data(), numbers.data()),
      "the values of \"" + variable.name + "\"");
  WholeNumbers kept([&](const std::string& type) { return make_volume_data(type, points); });
  kept.add(std::span<const Number>(numbers));
  if (kept.rounding().count > 0) note = kept.rounding().text(points);
  return kept.take();
}

/// The numbers as they are stored. Those of 64 bits that are scaled or may be missing are double.
VolumeData read_stored(const NetCdfVariable& variable, const std::vector<std::size_t>& start,
                       const std::vector<std::size_t>& count, std::size_t points,
                       const NetCdfMeaning& meaning, std::string& note) {
  if (meaning.is_plain() && meaning.missing.empty()) {
    if (variable.type == NC_INT64) {
      return read_whole_numbers<std::int64_t>(variable, start, count, points, note);
    }
    if (variable.type == NC_UINT64) {
      return read_whole_numbers<std::uint64_t>(variable, start, count, points, note);
    }
  }
  VolumeData data = make_volume_data(*stored_type(variable), points);
  const int status = std::visit(
      [&](auto& values) {
        void* const to = values.writable().data();
        if (variable.type == NC_INT64 || variable.type == NC_UINT64) {
          return nc_get_vara_double(variable.group, variable.id, start.data(), count.data(),
                                    static_cast<double*>(to));
        }
        return nc_get_vara(variable.group, variable.id, start.data(), count.data(), to);
      },
      data);
  check_net_cdf(status, "the values of \"" + variable.name + "\"");
  return data;
}

VolumeData with_meaning(VolumeData stored, const NetCdfMeaning& meaning) {
  return std::visit(
      [&](auto& values) -> VolumeData {
        using Value = typename std::decay_t<decltype(values)>::value_type;
        using Kept =
            std::conditional_t<sizeof(Value) <= 2 || std::is_same_v<Value, float>, float, double>;
        // Compared as they are stored: 1e20 as an attribute of double is another number in float.
        std::vector<Value> missing;
        for (const double number : meaning.missing) {
          const bool fits = std::is_floating_point_v<Value> ||
                            (number >= static_cast<double>(std::numeric_limits<Value>::lowest()) &&
                             number <= static_cast<double>(std::numeric_limits<Value>::max()));
          if (fits) missing.push_back(static_cast<Value>(number));
        }
        const auto is_missing = [&](Value value) {
          return std::find(missing.begin(), missing.end(), value) != missing.end();
        };
        if (meaning.is_plain() && std::none_of(values.begin(), values.end(), is_missing)) {
          return std::move(values);
        }
        if constexpr (std::is_same_v<Value, Kept>) {
          for (Value& value : values.writable()) {
            value = is_missing(value)
                        ? std::numeric_limits<Value>::quiet_NaN()
                        : static_cast<Value>(meaning.scale * static_cast<double>(value) +
                                             meaning.offset);
          }
          return std::move(values);
        } else {
          DataArray<Kept> kept(values.size());
          const std::span<Kept> to = kept.writable();
          for (std::size_t i = 0; i < values.size(); ++i) {
            to[i] = is_missing(values[i])
                        ? std::numeric_limits<Kept>::quiet_NaN()
                        : static_cast<Kept>(meaning.scale * static_cast<double>(values[i]) +
                                            meaning.offset);
          }
          return kept;
        }
      },
      stored);
}

}  // namespace

void list_grids(const std::filesystem::path& path, const AxisLetters&, GridContents& contents) {
  const NetCdfFile file(path);
  const std::vector<NetCdfVariable> variables = net_cdf_variables(file.id());
  for (const NetCdfVariable& variable : variables) {
    try {
      if (auto array = describe(variable)) {
        contents.arrays.push_back(*std::move(array));
      } else {
        contents.others.push_back({variable.name, {}});
      }
    } catch (const Error& error) {
      contents.others.push_back({variable.name, error.what()});
    }
  }
}

void read_grid(const std::filesystem::path& path, const std::string& name, const AxisLetters&,
               ComponentRange range, GridValues& values) {
  const NetCdfFile file(path);
  const std::vector<NetCdfVariable> variables = net_cdf_variables(file.id());
  const auto variable =
      std::ranges::find_if(variables, [&](const NetCdfVariable& v) { return v.name == name; });
  const std::optional<Axes> axes = variable == variables.end() ? std::nullopt : axes_of(*variable);
  if (!axes) throw Error("the file was changed while it was read");
  std::vector<std::size_t> start(variable->sides.size(), 0), count(variable->sides.size(), 1);
  std::array<std::int64_t, 3> sides{};
  for (std::size_t a = 0; a < 3; ++a) {
    sides[a] = static_cast<std::int64_t>(variable->sides[axes->first + 2 - a]);
  }
  const GridPart part = wanted_part(sides, range);
  const std::size_t points = value_count(part.box);
  for (std::size_t a = 0; a < 3; ++a) {
    start[axes->first + 2 - a] = static_cast<std::size_t>(part.box.first[a]);
    count[axes->first + 2 - a] = static_cast<std::size_t>(part.box.count[a]);
  }
  const NetCdfMeaning meaning = meaning_of(*variable);
  for (int c = range.first; c < range.first + range.number; ++c) {
    if (axes->components) start[*axes->components] = static_cast<std::size_t>(c);
    const VolumeData data =
        with_meaning(read_stored(*variable, start, count, points, meaning, values.note), meaning);
    std::visit(
        [&](const auto& of_type) {
          const auto all = std::as_bytes(std::span(of_type.data(), of_type.size()));
          const std::span<std::byte> to = values.next(std::string(type_name(data)));
          if (to.size() != all.size()) throw Error("the file was changed while it was read");
          std::ranges::copy(all, to.begin());
        },
        data);
  }
}

}  // namespace pellucid
