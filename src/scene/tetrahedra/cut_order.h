// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cell_cut.h"
#include "pellucid/scene/volume.h"

namespace pellucid {

/// Puts what lies together in space together in memory, which rays go through: the points of a new
/// cut, its tetrahedra and their cells, in the order of a Morton curve. `middle` is left as it was.
void put_in_spatial_order(CellCut& cut, const ParallelFor& parallel);

}  // namespace pellucid
