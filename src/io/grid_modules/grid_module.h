// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "axes/axis_meaning.h"
#include "pellucid/scene/error.h"
#include "volumes/components.h"

namespace pellucid {

/// A variable on a grid, in a file of HDF5, NetCDF or OpenVDB, as its module finds it.
struct GridArray {
  std::string name;
  std::string type;                     ///< of its values as they are read, if none is missing
  std::string type_with_missing;        ///< else; empty: none can be
  std::array<std::int64_t, 3> sides{};  ///< x, y, z: the last axis of the file is x
  int components = 1;
  std::string holds;             ///< what several are: "12 steps (axis time)"
  std::vector<double> times;     ///< of these steps, where the file says them
  std::string times_unit;        ///< text of the file: "hours since 2000-01-01"
  int components_of_a_step = 1;  ///< components that lie inside one step, the fastest ones
  std::array<AxisPositions, 3> positions;  ///< along x, y, z
  std::optional<GridPlacement> placement;  ///< in place of positions
  std::vector<std::string> notes;          ///< what is assumed, and what is not read
  /// True if a part is read without the rest (ComponentRange::part), in the type of the whole.
  bool reads_parts = false;
};

/// Array that is no volume of numbers.
struct GridOther {
  std::string name;
  std::string is;  ///< why: "a level set: …"; may be empty
};

/// Answer of a module. No exception leaves it; `error` is without the file's name.
struct GridContents {
  std::vector<GridArray> arrays;
  std::vector<GridOther> others;
  std::string error;
};
struct GridValues {
  /// Room for all values that are wanted of one component, the next, of this type.
  std::function<std::span<std::byte>(const std::string& type)> next;
  std::string error;
  std::string note;  ///< what a user should know of the values; may be empty
};

/// The functions of such a module, by these names. They are called in a process of their own, for
/// the libraries of these formats do not stand any file that is damaged.
/// `axes` are ReadOptions::axes, for formats whose axes have no names.
using AxisLetters = std::optional<std::string>;
using ListGrids = void(const std::filesystem::path& path, const AxisLetters& axes,
                       GridContents& answer);
using ReadGrid = void(const std::filesystem::path& path, const std::string& array,
                      const AxisLetters& axes, ComponentRange range, GridValues& answer);
inline constexpr const char* list_grids_name = "pellucid_list_grids_5";
inline constexpr const char* read_grid_name = "pellucid_read_grid_5";

/// Returns the part of a grid with these sides that is wanted; all of it where none is. Throws
/// Error where the part is one of another grid.
inline GridPart wanted_part(const std::array<std::int64_t, 3>& sides, ComponentRange range) {
  GridPart part{};
  for (std::size_t a = 0; a < 3; ++a) part.dimensions[a] = static_cast<int>(sides[a]);
  part.box.count = part.dimensions;
  if (range.part == nullptr) return part;
  if (range.part->dimensions != part.dimensions) {
    throw Error("the file was changed while it was read");
  }
  return *range.part;
}

/// Functions that each module defines under these names. They throw Error.
void list_grids(const std::filesystem::path& path, const AxisLetters& axes, GridContents& contents);
void read_grid(const std::filesystem::path& path, const std::string& name, const AxisLetters& axes,
               ComponentRange range, GridValues& values);

}  // namespace pellucid
