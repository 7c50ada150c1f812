// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/field/multichannel_grid.h"
#include "pellucid/render/half_opacity.h"
#include "pellucid/render/multivariate_integrator.h"
#include "pellucid/traverse/block_walk.h"
#include "pellucid/traverse/multivariate_blocks.h"
#include "pellucid/traverse/spans.h"

namespace pellucid {

/// Computes the data of several fields along a ray inside one cell. Returns false if the cell is
/// vacuum.
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

/// Moves the integrator along the ray; returns the number of cells.
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

/// Returns RayResult::half_opacity_depth of a ray with this opacity. If the given opacities differ
/// slightly from those of the ray, the result is at worst an end of the interval.
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

/// Integrates a ray (in grid coordinates, its parameter the world arc length) through several
/// trilinear fields, within a tolerance. `blocks` belong to the same grid; null: none.
/// `largest_extinction` is an upper bound on the extinction of the transfer function.
///
/// RayResult::error is at most the tolerance, unless even binary64 cannot resolve on which side of
/// a table's discontinuity the data lie, or so narrow a Gaussian.
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
