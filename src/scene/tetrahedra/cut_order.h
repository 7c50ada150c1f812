// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cell_cut.h"
#include "pellucid/scene/volume.h"

namespace pellucid {

/// Sorts the points of a new cut, its tetrahedra and their cells along a Morton curve, so that a
/// ray reads memory that lies together. Sets `numbers`; leaves `middle` as it was.
void put_in_spatial_order(CellCut& cut, const ParallelFor& parallel);

}  // namespace pellucid
