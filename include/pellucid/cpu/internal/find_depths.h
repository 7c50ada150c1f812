// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/cpu/render.h"

namespace pellucid {

/// A pixel's ray, and an optical depth >= 0 along it.
struct DepthRequest {
  int column = 0, row = 0;
  double optical_depth = 0;
};

/// Returns, for each request, the distance from the ray's origin, in world units, at which the
/// optical depth of the layers that are not projected reaches the number: counted from where the
/// ray enters the options' region, or from its origin; where the data end if it never does;
/// infinite if the ray passes the region by. Takes one ray per pixel. Uses of the options the
/// threads, the region and the stop token. Throws Error as render() does, and Cancelled.
std::vector<double> find_depths(const Scene& scene, const RenderOptions& options,
                                const std::vector<DepthRequest>& requests);

}  // namespace pellucid
