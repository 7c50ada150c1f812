// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "axis_meaning.h"
#include "volumes/volume_source.h"

namespace pellucid {

/// The unit that all axes of space have, or that lengths are turned into.
struct CommonUnit {
  std::string unit;
  std::array<double, 3> factor{1, 1, 1};  ///< of each axis to that unit
  std::string note;                       ///< begins with "its"; may be empty
};

/// Returns the unit of x, y and z, that of the first one that says one; "" where none does.
CommonUnit common_unit(const std::array<std::string, 3>& units);

/// Has longitudes in this unit that jump once, from 360 to 0 or from 180 to -180, go on. Returns
/// whether they did.
bool unwrap_longitudes(const std::string& unit, std::vector<double>& positions);

/// Places a grid by the positions along its axes, unless a spacing is given: turns lengths into one
/// unit and axes that grow downwards. Tells `note` what is done and what is not. Throws Error for
/// positions that are missing or not in order.
void place_axes(Volume::Description& description, const std::array<AxisPositions, 3>& positions,
                const ReadOptions& options);

}  // namespace pellucid
