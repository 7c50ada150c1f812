// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "layers/plane_ambiguity.h"
#include "pellucid/scene/volume.h"
#include "pellucid/traverse/spans.h"
#include "ray_tracer.h"

namespace pellucid {

/// Leaves rays to the general path that run along planes between cells, at which gradients `field`
/// jump: it charges them with what both sides of a plane differ by, one ray at a time. `parts` are
/// in the world.
inline void leave_rays_in_planes(const Volume& volume, const std::vector<RayPart>& parts,
                                 std::vector<RayResult>& results) {
  PlaneAmbiguity planes;
  volume.visit([&](const auto& grid) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const Ray<double> ray = volume.grid_from_world().ray(parts[i].ray);
      const Interval<double> inside = grid_interval(grid.axis, ray, parts[i].range);
      if (inside.empty()) continue;
      planes.start(volume.grid_from_world(), parts[i].ray);
      if (planes.runs_along_planes(ray, inside)) {
        results[i] = left_ray_result(RayStatus::for_one_ray);
      }
    }
  });
}

}  // namespace pellucid
