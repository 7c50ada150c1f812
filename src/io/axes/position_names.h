// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "axis_role.h"

namespace pellucid {

inline constexpr std::string_view axis_letters = "xyz";

/// The name of an array, in small letters, taken apart: "voxel_size_zyx_um" is "voxelsize", zyx and
/// um.
struct NameParts {
  std::vector<std::string> words;
  std::string bare;   ///< the words without what follows
  std::string order;  ///< "xyz" or "zyx"; empty: not said
  std::optional<std::size_t> axis;
  std::string units;
};
NameParts parts_of(const std::string& name);

/// Return whether a name is that of the distances of values, of the place of the first one, or of a
/// matrix from indices to places.
bool says_spacing(const NameParts& parts);
bool says_origin(const NameParts& parts);
bool says_matrix(const NameParts& parts);
/// Returns whether a name speaks of a place or of the values' scale.
bool speaks_of_places(const NameParts& parts);

/// "dx", "spacing_x", "y_step": a distance along one axis; "x0", "origin_z": its beginning.
enum class AlongOne { none, spacing, origin };
/// Returns which of them a name is, and of which axis.
AlongOne along_one(const NameParts& parts, std::size_t& axis);

/// Returns which of x, y and z the name of coordinates is, or time; else AxisRole::unknown.
AxisRole coordinate_role(const std::string& name);

}  // namespace pellucid
