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

#include "components.h"

namespace pellucid {

/// A variable on a grid, in a file of HDF5, NetCDF or OpenVDB, as its module finds it.
struct GridArray {
  std::string name;
  std::string type;                     ///< of its values as they are read, if none is missing
  std::string type_with_missing;        ///< else; empty: none can be
  std::array<std::int64_t, 3> sides{};  ///< x, y, z: the last axis of the file is x
  int components = 1;
  std::string holds;          ///< what several are: "12 steps (axis time)"
  std::vector<double> times;  ///< of these steps, where the file says them
  /// Where the values stand along x, y, z; empty: the file does not say. Each has the largest
  /// relative error that its type leaves it.
  std::array<std::vector<double>, 3> positions;
  std::array<double, 3> rounding{};
  std::optional<GridPlacement> placement;  ///< in place of positions
  std::string note;  ///< what is assumed where the file does not say it; may be empty
};

/// What is no volume of numbers.
struct GridOther {
  std::string name;
  std::string is;  ///< why: "a level set: …"; may be empty
};

/// What a module answers. No exception leaves it; `error` is without the file's name.
struct GridContents {
  std::vector<GridArray> arrays;
  std::vector<GridOther> others;
  std::string error;
};
struct GridValues {
  /// Room for all values of one component, the next, of this type.
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
inline constexpr const char* list_grids_name = "pellucid_list_grids_2";
inline constexpr const char* read_grid_name = "pellucid_read_grid_2";

/// What each module has of its own, behind these names. They throw.
void list_grids(const std::filesystem::path& path, const AxisLetters& axes, GridContents& contents);
void read_grid(const std::filesystem::path& path, const std::string& name, const AxisLetters& axes,
               ComponentRange range, GridValues& values);

}  // namespace pellucid
