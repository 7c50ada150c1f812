// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/field/sample.h"
#include "pellucid/render/ray_result.h"
#include "pellucid/segment/compositor.h"
#include "pellucid/segment/segment_rule.h"
#include "pellucid/traverse/structured_walk.h"

namespace pellucid {

/// Returns the transparency at which marching ends a ray, per unit of color: far below the accuracy
/// of any of the rules.
template <class T>
PELLUCID_HD constexpr double stop_tolerance() noexcept {
  return is_single<T> ? 1e-6 : 1e-10;
}

/// Returns the material at a position in grid coordinates, clamped into the box. A cell with a NaN
/// corner is vacuum.
template <class T, class Value>
PELLUCID_HD Material<T> sample_material(const StructuredGrid<Value, double>& grid,
                                        const PiecewiseLinear<T>& transfer,
                                        Vec3<double> position_grid) noexcept {
  const T value = sample_value<T>(grid, position_grid);
  if (is_nan(value)) return {};
  return transfer.evaluate(value);
}

/// Composites the steps of a march into the ray's result, up to the transparency `stop`, and
/// marches once more for the depth if `with_depth`. march(visit) calls visit(segment, t_begin,
/// t_end) front to back until it returns false.
template <class T, class March>
PELLUCID_HD void composite_march(March&& march, double stop, bool with_depth,
                                 RayResult& result) noexcept {
  FrontToBackCompositor<double> fold(stop);
  march([&](const SegmentResult<T>& segment, double, double) {
    ++result.cells;
    fold.add(segment);
    return !fold.done();
  });
  result.radiance = fold.radiance();
  result.optical_depth = fold.optical_depth();
  result.opacity = fold.opacity();
  if (with_depth && result.opacity > 0) {
    // Within the step that passes the half, the rules know no more than a constant extinction.
    const double target = -log1p(-0.5 * result.opacity);
    double before = 0;
    march([&](const SegmentResult<T>& segment, double t_begin, double t_end) {
      const double inside = static_cast<double>(segment.optical_depth);
      if (before + inside < target) {
        before += inside;
        return true;
      }
      result.half_opacity_depth = t_begin + (target - before) / inside * (t_end - t_begin);
      return false;
    });
  }
}

/// Marches a ray (in grid coordinates, its parameter the world arc length) through the grid's box
/// by a rule that takes materials, but `partial`, at the given step (world length, > 0). The last
/// step ends at the box. Positions are multiples of the step from the entry, computed from their
/// index, so that they do not drift.
template <class T, class Value>
PELLUCID_HD RayResult sample_ray(const StructuredGrid<Value, double>& grid,
                                 const Ray<double>& ray_grid, const PiecewiseLinear<T>& transfer,
                                 SegmentRule rule, double step, double largest_color,
                                 double stop_tolerance, bool with_depth) noexcept {
  RayResult result;
  const Interval<double> box = grid_interval(grid.axis, ray_grid);
  if (box.empty()) return result;
  const SamplePositions seen = sample_positions(rule);
  const auto sample = [&](bool wanted, double t) noexcept {
    return wanted ? sample_material<T>(grid, transfer, ray_grid.at(t)) : Material<T>{};
  };
  const auto march = [&](auto&& visit) {
    double t_begin = box.begin;
    Material<T> front = sample(seen.front, t_begin);
    for (long i = 1; t_begin < box.end; ++i) {
      const double t_end = min(box.begin + static_cast<double>(i) * step, box.end);
      const Material<T> middle = sample(seen.middle, 0.5 * (t_begin + t_end));
      const Material<T> back = sample(seen.front || seen.back, t_end);
      const SegmentResult<T> segment =
          material_segment(rule, PsiTable{}, front, middle, back, static_cast<T>(t_end - t_begin));
      if (!visit(segment, t_begin, t_end)) break;
      front = back;
      t_begin = t_end;
    }
  };
  composite_march<T>(march, stop_tolerance / max(largest_color, 1.0), with_depth, result);
  return result;
}

}  // namespace pellucid
