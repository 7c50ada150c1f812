// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "pellucid/scene/volume.h"

namespace pellucid {

/// Returns how many different values the volume has if it looks like labels (a segmentation, an
/// atlas, a mask): whole numbers, few of them, each filling regions, with jumps between regions
/// that skip the values in between. Returns nothing for other volumes, as for smooth data of 8
/// bits and for noise. A heuristic over up to 2^19 voxels; only where they look like labels, all
/// voxels are counted.
std::optional<std::size_t> label_count(const Volume& volume);

}  // namespace pellucid
