// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/cuda/device_scene.h"
#include "pellucid/render/sample_ray.h"
#include "pellucid/traverse/block_walk.h"

namespace pellucid {

/// Opacity left at which a sampled ray ends: what binary32 can tell of the light behind it.
inline constexpr double device_stop_tolerance = 1e-6;

/// Samples a ray (in grid coordinates) by the midpoint rule in binary32: the opponent of
/// integrate_ray() on the same device. Its samples are those of sample_ray(), from the same
/// positions; those in blocks where nothing absorbs are left out.
PELLUCID_HD inline RayResult sample_blocks(const DeviceScene& scene, const Ray<double>& ray_grid,
                                           Interval<double> part) noexcept {
  RayResult result;
  const AnyGrid& grid = scene.lit.grid;
  const Interval<double> box = grid_interval(grid.axis, ray_grid, part);
  if (box.empty()) return result;
  const double step = scene.sampling_step;
  FrontToBackCompositor<double> fold(device_stop_tolerance / max(scene.wanted.largest_color, 1.0));
  BlockWalk walk(scene.lit.blocks.records, ray_grid, box);
  BlockStep block;
  long next = 0;  // the first step that is not sampled yet
  while (!fold.done() && walk.next(scene.lit.blocks.classes.block, block)) {
    const bool skipped = scene.lit.blocks.classes[block.block].kind == BlockKind::skip;
    for (;;) {
      const double begin = box.begin + static_cast<double>(next) * step;
      const double end = min(begin + step, box.end);
      const double middle = 0.5 * (begin + end);
      if (!(begin < box.end) || !(middle < block.t_end)) break;
      if (skipped) {
        // All steps whose middles are in the block.
        const double behind = ceil((block.t_end - box.begin) / step - 0.5);
        next = max(next + 1, static_cast<long>(behind));
        continue;
      }
      ++next;
      ++result.cells;
      fold.add(
          midpoint_segment(sample_material<float>(grid, scene.transfer.single, ray_grid.at(middle)),
                           static_cast<float>(end - begin)));
      if (fold.done()) break;
    }
  }
  result.radiance = fold.radiance();
  result.optical_depth = fold.optical_depth();
  result.opacity = fold.opacity();
  result.evaluations = result.cells;
  return result;
}

}  // namespace pellucid
