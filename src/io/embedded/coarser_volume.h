// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "pellucid/scene/volume.h"

namespace pellucid {

/// Way of making one value of several.
enum class Merging {
  mean,        ///< Mean of the values that are numbers; of integers rounded
  most_common  ///< Value of the most, for labels
};

/// Axes with fewer values are not made coarser.
inline constexpr int fewest_coarsened = 16;

/// Returns the volume in the same box with half as many values along each axis of 16 or more. A
/// value of points is made of the piecewise linear field around it, so that linear fields stay the
/// same, and the outermost stay as they are; one of cells of the cells that it covers. Returns null
/// where no axis is long enough, and for rectilinear axes with values in cells.
std::shared_ptr<const Volume> coarser_volume(const Volume& volume, Merging merging);

}  // namespace pellucid
