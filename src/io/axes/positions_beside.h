// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "axis_meaning.h"
#include "pellucid/scene/volume.h"

// Positions that stand as arrays of their own beside an array of values, in HDF5 and in archives of
// numpy: "spacing", "origin", "affine", coordinates "x", "y", "z". Needs pellucid::scene alone.

namespace pellucid {

/// An array beside an array of values, by its name without those of groups.
struct ArrayBeside {
  std::string name;
  std::vector<std::int64_t> shape;
  std::vector<double> numbers = {};  ///< the last axis fastest; empty: not read, or no numbers
  std::string units = {};            ///< by its attributes; empty: they say none
  bool is_of_several = false;        ///< whether it stands beside arrays of values of other sides
};

/// The most values that such an array has but for coordinates, which are as many as a side has.
inline constexpr std::int64_t most_beside = 64;

/// Returns whether the name and the shape are those of positions, so that the numbers are of use.
/// `shape` is that of the array of values beside it.
bool may_say_positions(const ArrayBeside& array, std::span<const std::int64_t> shape);

/// Axes of an array of values, and facts that are not taken into account.
struct PositionsBeside {
  std::array<std::size_t, 3> space{};      ///< the axes that are x, y and z
  std::array<AxisPositions, 3> positions;  ///< along x, y, z; without numbers: nothing is said
  std::optional<GridPlacement> placement;  ///< in place of positions
  std::vector<double> times;               ///< along the one axis of components; empty: not said
  std::vector<std::string> notes;          ///< each begins with "its"
};

/// Known axes of an array of values.
struct KnownAxes {
  std::array<std::size_t, 3> space{};     ///< x, y, z
  std::optional<std::size_t> components;  ///< the fourth
  bool is_said = false;                   ///< whether it is stated, and no guess
  bool is_placed = false;                 ///< whether the array says its positions itself
};

/// Returns what arrays beside an array of this shape say of it. Axes that are a guess are turned
/// where coordinates or a matrix say so. Spacings of one number, and those that are the same from
/// both ends, are plain; others must say whether they begin with x or with z. A matrix "affine" is
/// nibabel's: it maps the indices, in the order of the axes, to right, anterior and superior.
PositionsBeside positions_beside(std::span<const ArrayBeside> arrays,
                                 std::span<const std::int64_t> shape, const KnownAxes& axes);

}  // namespace pellucid
