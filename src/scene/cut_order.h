// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "cell_cut.h"
#include "pellucid/scene/volume.h"

namespace pellucid {

/// Puts what lies together in space together in memory, which rays go through: points and
/// tetrahedra, and their cells, in the order of a Morton curve. Returns the numbers that the points
/// had. `middle` is left as it was.
std::vector<std::int32_t> put_in_spatial_order(CellCut& cut, const ParallelFor& parallel);

/// Values of points in the order that put_in_spatial_order() returned.
VolumeData reordered(const VolumeData& values, const std::vector<std::int32_t>& order);

}  // namespace pellucid
