// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "grid/field.h"
#include "mixture.h"
#include "pellucid/reference/render.h"

namespace pellucid::reference {

/// Returns the volume rendering integral through several channels along a ray with a direction of
/// length 1. Adds the number of cells crossed to `cells`.
ReferencePixel integrate(const Field& field, const Mixture& mixture, const RealRay& ray,
                         bool with_depth, std::uint64_t& cells);

}  // namespace pellucid::reference
