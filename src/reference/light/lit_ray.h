// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "lit_layer.h"
#include "pellucid/reference/render.h"

namespace pellucid::reference {

/// Returns the volume rendering integral as in layered_ray.h, through layers of which some have
/// light, gradient opacity or surfaces.
ReferencePixel integrate(const std::vector<std::unique_ptr<const LitLayer>>& layers,
                         const std::vector<Light>& lights, const RealRay& ray, bool with_depth,
                         std::uint64_t& cells, Real end);

}  // namespace pellucid::reference
