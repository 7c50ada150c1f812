// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/cluster/communicator.h"
#include "pellucid/cpu/internal/projected_rays.h"

namespace pellucid {

/// Joins the parts of a layer's values that the ranks have; all get the whole.
void join(Communicator& ranks, ProjectedRays& rays);

/// Puts the projected layers of a scene over composited rays. `values` are of its visible projected
/// layers, in their order.
void put_projections_over(const Scene& scene, const std::vector<ProjectedRays>& values,
                          std::vector<RayPixel>& rays);

}  // namespace pellucid
