// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "pellucid/scene/volume.h"

namespace pellucid {

/// Returns the number of different values if the volume looks like labels (a segmentation, an
/// atlas, a mask); none for other volumes, such as smooth data of 8 bits or noise. Labels are few
/// integers that fill regions, with jumps between regions that skip the integers in between. This
/// is a heuristic over up to 2^19 voxels; if they look like labels, it counts all voxels.
std::optional<std::size_t> label_count(const Volume& volume);

}  // namespace pellucid
