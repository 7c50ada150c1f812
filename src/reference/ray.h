// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "grid.h"
#include "piece.h"

namespace pellucid::reference {

/// The volume rendering integral along a ray with a direction of length 1. Adds the number of cells
/// crossed to `cells`.
ReferencePixel integrate(const Grid& grid, const Table& table, const RealRay& ray, bool with_depth,
                         std::uint64_t& cells);

}  // namespace pellucid::reference
