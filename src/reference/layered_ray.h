// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "layer_data.h"
#include "pellucid/reference/render.h"

namespace pellucid::reference {

/// Returns the volume rendering integral through layers, which are a mixture where they overlap,
/// along a ray with a direction of length 1, up to `end`. Adds the number of cells crossed to
/// `cells`.
ReferencePixel integrate(const std::vector<std::unique_ptr<const LayerData>>& layers,
                         const RealRay& ray, bool with_depth, std::uint64_t& cells, Real end);

}  // namespace pellucid::reference
