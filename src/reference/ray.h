// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "grid/field.h"
#include "pellucid/reference/render.h"
#include "table.h"

namespace pellucid::reference {

/// Returns the volume rendering integral through one channel along a ray with a direction of length
/// 1. Adds the number of cells crossed to `cells`.
ReferencePixel integrate(const Field& field, const Table& table, const RealRay& ray,
                         bool with_depth, std::uint64_t& cells);

}  // namespace pellucid::reference
