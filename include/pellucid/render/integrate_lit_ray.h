// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/base/device_call.h"
#include "pellucid/field/any_grid.h"
#include "pellucid/field/grid_gradient.h"
#include "pellucid/render/half_opacity.h"
#include "pellucid/render/multivariate_integrator.h"
#include "pellucid/segment/lit_cuts.h"
#include "pellucid/traverse/block_walk.h"
#include "pellucid/traverse/spans.h"

namespace pellucid {

/// A grid of one variable with a transfer function in the light of a scene. A view; owns nothing.
struct LitGrid {
  AnyGrid grid;
  Affine<double> grid_from_world;
  ClassifiedBlocks blocks;
  PiecewiseLinear<double> transfer;
  double largest_extinction = 0;  ///< of the function, with gradient_opacity
  bool is_lit = false;            ///< whether it has a reflection; gradient opacity alone has none
  Reflection<double> reflection;
  const LightSource<double>* light = nullptr;
  int lights = 0;
  bool field_gradient = false;  ///< GradientKind::field; else smooth
  bool has_gradient_opacity = false;
  PiecewiseLinear<double> gradient_opacity;  ///< factors as extinctions
};

namespace detail {

/// One cell of a lit grid along a ray.
class LitCell {
 public:
  /// Keeps references to its arguments. `world`: the ray, its direction of length 1. `range`: of
  /// the cell on it.
  PELLUCID_HD LitCell(const LitGrid& lit, const Ray<double>& world, Interval<double> range,
                      const LitLayer<double>& layer) noexcept
      : layer_(layer), length_(range.end - range.begin) {
    stretch_.layer = &layer;
    stretch_.layers = 1;
    stretch_.light = lit.light;
    stretch_.lights = lit.lights;
    stretch_.begin = world.origin + world.direction * range.begin;
    stretch_.direction = world.direction;
    stretch_.length = length_;
    stretch_.gradient_error = gradient_rounding<double>;
    end_ = world.origin + world.direction * range.end;
  }

  PELLUCID_HD double length() const noexcept { return length_; }
  template <class Allowance>
  PELLUCID_HD PELLUCID_DEVICE_CALL PanelSegment<double> panel(
      double begin, double end, const PanelDemand<double>& demand,
      const Allowance& allowance) const noexcept {
    const LitLayer<double> part = layer_.part(begin, end);
    return integrate_lit_panel(stretch_, &part, begin, end, demand, allowance);
  }

  /// Calls visit(first, last) for the parts between two cuts, front to back, while it returns true.
  /// Cuts are gathered some at a time: there is no room for all control points of a table.
  template <class Visit>
  PELLUCID_HD void for_each_piece(Visit&& visit) const noexcept {
    constexpr int room = 12;
    double begin = 0;
    for (;;) {
      double cut[room]{};
      int count = 0;
      for_each_lit_cut(layer_, stretch_.light, stretch_.lights, stretch_.begin, end_,
                       stretch_.direction, [&](double u) noexcept {
                         if (u - begin < shortest_lit_piece || 1 - u < shortest_lit_piece) return;
                         int i = count < room ? count++ : room;
                         if (i == room && !(u < cut[--i])) return;  // the farthest one goes
                         for (; i > 0 && u < cut[i - 1]; --i) cut[i] = cut[i - 1];
                         cut[i] = u;
                       });
      for (int i = 0; i < count; ++i) {
        if (cut[i] - begin < shortest_lit_piece) continue;
        if (!visit(begin, cut[i])) return;
        begin = cut[i];
      }
      if (count < room) break;
    }
    visit(begin, 1.0);
  }

 private:
  const LitLayer<double>& layer_;
  double length_;
  LitStretch<double> stretch_;
  Vec3<double> end_{};
};

/// Computes what light needs of a cell. Returns false in vacuum.
PELLUCID_HD PELLUCID_DEVICE_CALL inline bool make_lit_layer(
    const LitGrid& lit, const StructuredWalk<double>::Step& step,
    LitLayer<double>& layer) noexcept {
  CubicSpan<double> span;
  if (!make_span(lit.grid, step, span)) return false;
  layer.span.data[0] = span.data;
  layer.span.length = step.t_end - step.t_begin;
  const auto smooth = [&]() noexcept {
    return lit.grid.visit([&](const auto& grid) noexcept {
      return smooth_gradients(grid, step.cell, [&](int axis, int value) noexcept {
        return neighbor_distances(grid.axis[axis], value);
      });
    });
  };
  const Mat3<double>& to_grid = lit.grid_from_world.matrix;
  const CornerGradients corners = lit.field_gradient
                                      ? lit.grid.visit([&](const auto& grid) noexcept {
                                          return field_gradients(grid, step.cell);
                                        })
                                      : smooth();
  gradients_along(corners, to_grid, step.entry, step.exit, layer.gradient);
  if (lit.has_gradient_opacity) {
    layer.magnitude =
        magnitude_along(lit.field_gradient ? smooth() : corners, to_grid, step.entry, step.exit);
  }
  return true;
}

/// Moves the integrator along the ray; returns the number of cells that are not vacuum.
PELLUCID_HD PELLUCID_DEVICE_CALL inline long follow_lit_ray(
    const LitGrid& lit, const MultivariateTransfer<double>& all, const Ray<double>& world,
    const Ray<double>& ray_grid, Interval<double> inside,
    MultivariateRayIntegrator& integrator) noexcept {
  LitLayer<double> layer;
  layer.transfer = &all;
  layer.reflection = lit.is_lit ? &lit.reflection : nullptr;
  layer.gradient_opacity = lit.has_gradient_opacity ? &lit.gradient_opacity : nullptr;
  long cells = 0;
  BlockWalk walk(lit.blocks.records, ray_grid, inside);
  BlockStep block;
  while (!integrator.done() && walk.next(lit.blocks.classes.block, block)) {
    if (lit.blocks.classes[block.block].kind == BlockKind::skip) {
      integrator.skip(block.t_end - block.t_begin, 0);
      continue;
    }
    StructuredWalk<double> cell_walk(lit.grid.axis, ray_grid, {block.t_begin, block.t_end});
    StructuredWalk<double>::Step step;
    while (!integrator.done() && cell_walk.next(step)) {
      const Interval<double> range{step.t_begin, step.t_end};
      if (!make_lit_layer(lit, step, layer)) {
        integrator.skip(range.end - range.begin, 0);
        continue;
      }
      ++cells;
      const LitCell cell(lit, world, range, layer);
      // Of the planes of the grid, and of the ends in the world.
      const double position_error = 16 * rounding_unit<double> * range.end;
      cell.for_each_piece([&](double first, double last) noexcept {
        const LitPiece<LitCell> piece{cell, first, last};
        // If the cell's length changes, inner cuts move in proportion.
        const double share = first == 0 || last == 1 ? 1 : last - first;
        integrator.add_panels(
            piece, {range.begin + first * cell.length(), range.begin + last * cell.length()}, 0,
            share * position_error);
        return !integrator.done();
      });
    }
  }
  return cells;
}

}  // namespace detail

/// Integrates a ray (in the world, its direction of length 1) through a lit grid, within a
/// tolerance; of the ray, the part in `part`.
///
/// RayResult::error is at most the tolerance, unless the light needs more panels than a ray has, or
/// even binary64 cannot resolve on which side of a discontinuity the data lie.
PELLUCID_HD inline RayResult integrate_lit_ray(
    const LitGrid& lit, const Ray<double>& world, const RayTolerance& wanted, bool with_depth,
    Interval<double> part = HalfOpacity{}.range) noexcept {
  const Ray<double> ray_grid = lit.grid_from_world.ray(world);
  const Interval<double> inside = grid_interval(lit.grid.axis, ray_grid, part);
  if (inside.empty()) return missed_ray_result();
  const ChannelTable<double> table{0, lit.transfer};
  MultivariateTransfer<double> all;
  all.table = &table;
  all.tables = 1;
  MultivariateRayIntegrator integrator(all, lit.largest_extinction, wanted,
                                       inside.end - inside.begin);
  const long cells = detail::follow_lit_ray(lit, all, world, ray_grid, inside, integrator);
  RayResult result = integrator.result();
  result.cells = cells;
  if (with_depth && result.opacity > 0) {
    MultivariateRayIntegrator search(all, lit.largest_extinction, wanted,
                                     inside.end - inside.begin);
    search.set_target_depth(HalfOpacity{part}.depth_to_half(result.opacity));
    detail::follow_lit_ray(lit, all, world, ray_grid, inside, search);
    result.half_opacity_depth = min(search.target_position(), inside.end);
  }
  return result;
}

}  // namespace pellucid
