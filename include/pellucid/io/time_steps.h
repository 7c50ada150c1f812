// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pellucid/io/field_source.h"
#include "pellucid/io/mesh_source.h"

namespace pellucid {

/// Times of steps, and their unit as the file writes it: "s", "hours since 2000-01-01".
struct StepTimes {
  std::vector<double> times = {};
  std::string unit = {};  ///< empty: the file says none
};

/// Returns the times of the steps of a source, ascending and different. Empty: it has no steps.
/// Reads headers and coordinates, no values. A time in the source's options changes nothing, and
/// steps whose time is missing (NaN) are left out. Throws Error as reading would.
StepTimes source_steps(const FieldSource& source);
StepTimes source_steps(const MeshSource& source);
/// Return these times without their unit.
std::vector<double> source_times(const FieldSource& source);
std::vector<double> source_times(const MeshSource& source);

}  // namespace pellucid
