// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "variable_attributes.h"

namespace pellucid {

/// The words that a file has for one axis of an array; empty where it has none.
struct AxisText {
  std::string name;
  std::string type;               ///< as OME-Zarr has it: "space", "time", "channel"
  VariableAttributes coordinate;  ///< of the variable that has the positions
  std::string coordinate_name;    ///< its name, where that is another
};

/// The meaning of an axis; a corner is one of a cell's.
enum class AxisRole { unknown, x, y, z, time, member, channel, corner };

/// A meaning, and how well it is known: an attribute that states it is stronger than a unit, and a
/// unit is stronger than a name.
struct AxisEvidence {
  AxisRole role = AxisRole::unknown;
  int strength = 0;

  /// Returns whether the axis' name is all that there is.
  bool is_by_name() const noexcept { return strength <= 2; }
};

/// Returns the meaning of an axis, without regard to the others: by the attributes of the CF
/// conventions, else by the names that models and programs give their axes.
AxisEvidence axis_evidence(const AxisText& axis);

/// Returns how surely an axis of time has the time of its values: least for the time of a
/// forecast's start, or since then.
int time_rank(const AxisText& axis);

/// Returns whether the name is that of an image's columns, or of its rows.
bool is_image_width(const std::string& name);
bool is_image_height(const std::string& name);
/// Returns whether the name is a single letter that means something beside x, y and z alone.
bool is_bare_letter(const std::string& name);

/// Returns whether the axis is said to grow downwards, and whether its meaning lets expect it.
bool grows_down(const AxisText& axis);
bool may_grow_down(const AxisText& axis);

}  // namespace pellucid
