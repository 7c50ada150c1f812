// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/io/field_source.h"
#include "pellucid/io/mesh_source.h"

namespace pellucid {

/// Returns the times of the steps of a source, ascending and different, in the unit of the file.
/// Empty: it has no steps. Reads headers and coordinates, no values. A time in the source's options
/// changes nothing, and steps whose time is missing (NaN) are left out. Throws Error as reading
/// would.
std::vector<double> source_times(const FieldSource& source);
std::vector<double> source_times(const MeshSource& source);

}  // namespace pellucid
