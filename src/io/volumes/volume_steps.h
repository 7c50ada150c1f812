// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "components.h"

namespace pellucid {

/// Steps in time among the components of a file.
struct VolumeSteps {
  std::vector<double> times = {};  ///< in the order of the file; NaN: the file lacks it
  std::string unit = {};           ///< unit of the times; empty: the file says none
  int inside = 1;                  ///< components that lie inside one step, the fastest ones
};

/// Puts the times of the steps into `file`, whose grid and reader are complete. Keeps the step
/// nearest to the time that the options ask for, or tells which there are. Several components of a
/// step stay components. `subject` begins messages: "a.nc: \"v\" ". Throws Error where a time is
/// asked for and there is none, where one component of each step and a time are asked for, and for
/// movies of one plane.
void take_steps(const VolumeSteps& steps, const ReadOptions& options, const std::string& subject,
                VolumeFile& file);

/// Returns (1 - share) · before + share · after, in double; as float, or as double where one of
/// them is. Both have as many values.
VolumeData values_between(const VolumeData& before, const VolumeData& after, double share);
/// Returns the same of volumes. Throws Error where their grids differ.
Volume volume_between(const Volume& before, const Volume& after, const std::string& name,
                      double share);

}  // namespace pellucid
