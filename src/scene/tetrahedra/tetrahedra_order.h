// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/scene/volume.h"
#include "tetrahedralized_cells.h"

namespace pellucid {

/// Sorts points, tetrahedra and their cells along a Morton curve, so that a ray reads memory that
/// lies together. Sets `numbers`, which is empty before; leaves `added` as it was.
void put_in_spatial_order(TetrahedralizedCells& cells, const ParallelFor& parallel);

}  // namespace pellucid
