// SPDX-License-Identifier: Apache-2.0
#include "tetrahedra_arrays.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>

#include "grid_check.h"

namespace pellucid {
namespace {

/// Type that holds combinations of values: of numbers of 16 bits float does, exactly.
template <class Value>
using Combined =
    std::conditional_t<std::is_same_v<Value, float> || sizeof(Value) <= 2, float, double>;

template <class Value>
VolumeData taken(const DataArray<Value>& values, std::size_t components,
                 const std::vector<std::int32_t>& from) {
  DataArray<Value> carried(from.size() * components);
  Value* out = carried.writable().data();
  for (const std::int32_t c : from) {
    out = std::copy_n(values.data() + static_cast<std::size_t>(c) * components, components, out);
  }
  return carried;
}

template <class Value>
VolumeData at_points(const DataArray<Value>& values, std::size_t components,
                     const std::vector<AddedPoint>& added) {
  if (added.empty()) return values;
  using Number = Combined<Value>;
  DataArray<Number> carried(values.size() + added.size() * components);
  Number* out = carried.writable().data();
  for (const Value value : values) *out++ = static_cast<Number>(value);
  for (const AddedPoint& point : added) {
    for (std::size_t c = 0; c < components; ++c) {
      *out++ = static_cast<Number>(point.interpolated([&](std::int32_t node) {
        return static_cast<double>(values[static_cast<std::size_t>(node) * components + c]);
      }));
    }
  }
  return carried;
}

VolumeData component_of(const MeshArray& array, int component) {
  if (array.components == 1) return array.values;
  return std::visit(
      [&](const auto& values) -> VolumeData {
        using Value = typename std::decay_t<decltype(values)>::value_type;
        const auto step = static_cast<std::size_t>(array.components);
        DataArray<Value> taken(values.size() / step);
        std::size_t from = static_cast<std::size_t>(component);
        for (Value& value : taken.writable()) {
          value = values[from];
          from += step;
        }
        return taken;
      },
      array.values);
}

VolumeData lengths(const VolumeData& vectors, int components) {
  return std::visit(
      [&](const auto& values) -> VolumeData {
        using Number = Combined<typename std::decay_t<decltype(values)>::value_type>;
        const auto step = static_cast<std::size_t>(components);
        DataArray<Number> lengths(values.size() / step);
        std::size_t from = 0;
        for (Number& length : lengths.writable()) {
          double squares = 0;
          for (const std::size_t end = from + step; from < end; ++from) {
            const auto x = static_cast<double>(values[from]);
            squares += x * x;
          }
          length = static_cast<Number>(std::sqrt(squares));
        }
        return lengths;
      },
      vectors);
}

/// Returns the names of the arrays: "\"a\", \"b\" (cells)".
std::string names_of(const UnstructuredGrid& grid) {
  std::string names;
  for (const MeshArray& array : grid.arrays) {
    names += (names.empty() ? "\"" : ", \"") + array.name + "\"";
    if (array.centering == Centering::cell) names += " (of cells)";
  }
  return names;
}

}  // namespace

VolumeData carried(const UnstructuredGrid& grid, const MeshArray& array,
                   const TetrahedralizedCells& cells) {
  check_array(grid, array);
  const auto components = static_cast<std::size_t>(array.components);
  const auto taken_from = [&](const VolumeData& data, const std::vector<std::int32_t>& from) {
    return std::visit([&](const auto& values) { return taken(values, components, from); }, data);
  };
  if (array.centering == Centering::cell) return taken_from(array.values, cells.cell);
  VolumeData carried = std::visit(
      [&](const auto& values) { return at_points(values, components, cells.added.points); },
      array.values);
  return cells.numbers.empty() ? carried : taken_from(carried, cells.numbers);
}

const MeshArray& chosen_array(const UnstructuredGrid& grid, const MeshArrayChoice& choice) {
  const MeshArray* found = nullptr;
  for (const MeshArray& array : grid.arrays) {
    if (array.name != choice.array) continue;
    if (found == nullptr ||
        (found->centering == Centering::cell && array.centering == Centering::point)) {
      found = &array;
    }
  }
  if (found == nullptr) {
    fail(grid, "there is no array \"" + choice.array + "\"; " +
                   (grid.arrays.empty() ? "it has none" : "it has " + names_of(grid)));
  }
  if (const auto c = choice.component; c && (*c < 0 || *c >= found->components)) {
    fail(grid, "array \"" + choice.array + "\" has no component " + std::to_string(*c) + "; " +
                   (found->components == 1
                        ? "its only one is 0"
                        : "choose from 0 to " + std::to_string(found->components - 1)));
  }
  check_array(grid, *found);
  return *found;
}

MeshChannel chosen_channel(const UnstructuredGrid& grid, const MeshArrayChoice& choice,
                           const TetrahedralizedCells& cells) {
  const MeshArray& array = chosen_array(grid, choice);
  MeshChannel channel;
  channel.name = choice.name.empty() ? array.name : choice.name;
  channel.centering = array.centering;
  if (choice.component || array.components == 1) {
    const MeshArray component{array.name, array.centering, 1,
                              component_of(array, choice.component.value_or(0))};
    channel.values = carried(grid, component, cells);
  } else {
    // The length of the vector between, not what is between the lengths.
    channel.values = lengths(carried(grid, array, cells), array.components);
  }
  return channel;
}

}  // namespace pellucid
