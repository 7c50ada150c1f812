// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/field/multichannel_grid.h"
#include "pellucid/render/half_opacity.h"
#include "pellucid/render/multivariate_integrator.h"
#include "pellucid/traverse/block_walk.h"
#include "pellucid/traverse/multivariate_blocks.h"
#include "pellucid/traverse/spans.h"

namespace pellucid {

/// What a ray sees of several fields inside one cell; false where it is vacuum.
template <class T>
PELLUCID_HD bool make_multivariate_span(const MultichannelGrid& grid,
                                        const StructuredWalk<double>::Step& step,
                                        MultivariateSpan<T>& span) noexcept {
  span.length = static_cast<T>(step.t_end - step.t_begin);
  for (int c = 0; c < grid.channels; ++c) {
    const bool filled = grid.visit_channel(c, [&](const auto& field) noexcept {
      CubicSpan<T> one;
      if (!make_span(field, step, one)) return false;
      span.data[c] = one.data;
      return true;
    });
    if (!filled) return false;
  }
  return true;
}

namespace detail {

/// Takes the integrator along the ray; returns the number of cells.
PELLUCID_HD inline long follow_ray(const MultichannelGrid& grid, const MultivariateBlocks* blocks,
                                   const Ray<double>& ray_grid, Interval<double> inside,
                                   MultivariateRayIntegrator& integrator) noexcept {
  long cells = 0;
  const auto each_cell = [&](Interval<double> range, PrimitiveSet primitives, double left_out) {
    StructuredWalk<double> walk(grid.axis, ray_grid, range);
    StructuredWalk<double>::Step step;
    while (!integrator.done() && walk.next(step)) {
      ++cells;
      MultivariateSpan<double> span;
      if (make_multivariate_span(grid, step, span)) {
        integrator.add_stretch(span, {step.t_begin, step.t_end}, primitives, left_out,
                               8 * rounding_unit<double> * step.t_end);
      } else {
        integrator.skip(span.length, 0);
      }
    }
  };
  if (blocks == nullptr) {
    each_cell(inside, PrimitiveSet{}, 0);
    return cells;
  }
  BlockWalk walk(blocks->records, ray_grid, inside);
  BlockStep step;
  while (!integrator.done() && walk.next(blocks->classes.block, step)) {
    if (blocks->classes[step.block].kind == BlockKind::skip) {
      integrator.skip(step.t_end - step.t_begin, blocks->left_out);
    } else {
      each_cell({step.t_begin, step.t_end}, blocks->primitives[step.block], blocks->left_out);
    }
  }
  return cells;
}

}  // namespace detail

/// RayResult::half_opacity_depth of a ray of this opacity. Where the opacities that are given are
/// not quite those of the ray, it is an end of the stretch at the worst.
PELLUCID_HD inline double find_multivariate_half_opacity(
    const MultichannelGrid& grid, const MultivariateBlocks* blocks, const Ray<double>& ray_grid,
    const MultivariateTransfer<double>& transfer, double largest_extinction,
    const RayTolerance& wanted, double opacity, const HalfOpacity& half = {}) noexcept {
  if (!(opacity > 0)) return std::numeric_limits<double>::infinity();
  const Interval<double> inside = grid_interval(grid.axis, ray_grid, half.range);
  if (inside.empty()) return half.range.end;
  MultivariateRayIntegrator integrator(transfer, largest_extinction, wanted,
                                       inside.end - inside.begin);
  integrator.set_target_depth(half.depth_to_half(opacity));
  detail::follow_ray(grid, blocks, ray_grid, inside, integrator);
  return min(integrator.target_position(), half.range.end);
}

/// The volume rendering integral along a ray (in grid coordinates, its parameter the world arc
/// length) through several trilinear fields, within a tolerance: RayResult::error is at most what
/// is wanted, unless not even binary64 tells on which side of a jump of a table the data lie, or
/// keeps so narrow a Gaussian. `blocks`: of the same grid; null: none. `largest_extinction`: a
/// bound on that of the transfer function.
PELLUCID_HD inline RayResult integrate_multivariate_ray(
    const MultichannelGrid& grid, const MultivariateBlocks* blocks, const Ray<double>& ray_grid,
    const MultivariateTransfer<double>& transfer, double largest_extinction,
    const RayTolerance& wanted, bool with_depth) noexcept {
  const Interval<double> inside = grid_interval(grid.axis, ray_grid);
  if (inside.empty()) return missed_ray_result();

  MultivariateRayIntegrator integrator(transfer, largest_extinction, wanted,
                                       inside.end - inside.begin);
  const long cells = detail::follow_ray(grid, blocks, ray_grid, inside, integrator);
  RayResult result = integrator.result();
  result.cells = cells;
  result.evaluations = cells;
  if (with_depth) {
    result.half_opacity_depth = find_multivariate_half_opacity(
        grid, blocks, ray_grid, transfer, largest_extinction, wanted, result.opacity);
  }
  return result;
}

}  // namespace pellucid
