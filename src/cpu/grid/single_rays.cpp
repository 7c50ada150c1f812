// SPDX-License-Identifier: Apache-2.0
#include "single_rays.h"

#include "pellucid/render/integrate_ray.h"

namespace pellucid {

bool has_single_rays() noexcept {
  return true;
}

std::vector<RayResult> trace_single_rays(const SingleRays& of, const std::vector<RayPart>& in_grid,
                                         const RayTolerance& wanted, const std::stop_token& stop) {
  std::vector<RayResult> results(in_grid.size());
  of.volume.visit([&](const auto& grid) {
    for (std::size_t i = 0; i < in_grid.size() && !stop.stop_requested(); ++i) {
      results[i] = integrate_ray(grid, of.blocks, in_grid[i].ray, of.transfer, wanted, of.depth,
                                 in_grid[i].range);
    }
  });
  return results;
}

}  // namespace pellucid
