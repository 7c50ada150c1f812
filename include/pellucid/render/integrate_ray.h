// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/solve_monotone.h"
#include "pellucid/render/half_opacity.h"
#include "pellucid/render/stride_march.h"

namespace pellucid {

/// Returns the world arc length at which the optical depth, counted from the begin of `range`,
/// reaches `target`; infinite if it never does. Accurate to 16 u of a cell or of the optical depth
/// inside it.
template <class T, class Value>
PELLUCID_HD double find_optical_depth(const StructuredGrid<Value, double>& grid,
                                      const Ray<double>& ray_grid, Interval<double> range,
                                      const PiecewiseLinear<T>& transfer, double target) noexcept {
  double before = 0;
  double found = std::numeric_limits<double>::infinity();
  for_each_span<T>(
      grid, ray_grid,
      [&](const CubicSpan<T>& span) {
        const T length = span.length();
        const double inside = static_cast<double>(optical_depth_cubic(span.data, length, transfer));
        if (before + inside < target) {
          before += inside;
          return true;
        }
        const auto up_to = [&](double end) noexcept {
          const T u = static_cast<T>(end);
          return static_cast<double>(
              optical_depth_cubic(restrict_to(span.data, T(0), u), length * u, transfer));
        };
        found = span.t_begin + solve_monotone(up_to, target - before, 0, 1, 0, inside,
                                              16 * double{rounding_unit<T>}) *
                                   (span.t_end - span.t_begin);
        return false;
      },
      range);
  return found;
}

/// Returns RayResult::half_opacity_depth of a ray with this opacity. If the given opacities differ
/// slightly from those of the ray, the result is at worst an end of the interval.
template <class Value>
PELLUCID_HD double find_half_opacity(const StructuredGrid<Value, double>& grid,
                                     const Ray<double>& ray_grid, const TransferTables& transfer,
                                     Precision precision, double opacity,
                                     const HalfOpacity& half = {}) noexcept {
  if (!(opacity > 0)) return std::numeric_limits<double>::infinity();
  const double target = half.depth_to_half(opacity);
  const double found =
      precision == Precision::float32
          ? find_optical_depth<float>(grid, ray_grid, half.range, transfer.single, target)
          : find_optical_depth<double>(grid, ray_grid, half.range, transfer.wide, target);
  return min(found, half.range.end);
}

/// Integrates the blocks of a ray: uniform blocks at once, smooth blocks together with smooth
/// neighbors, and all others cell by cell.
template <class Integrator, class EachCell>
PELLUCID_HD void integrate_blocks(const ClassifiedBlocks& blocks, const Ray<double>& ray_grid,
                                  Interval<double> inside, Integrator& integrator,
                                  EachCell&& each_cell) noexcept {
  const BlockRecords& records = blocks.records;
  StrideMarch march(ray_grid.direction, records.least_width, records.mean_width);
  Interval<double> smooth{inside.begin, inside.begin};
  CurvatureBounds curvature{};
  const auto finish = [&] {
    if (smooth.begin < smooth.end) march.run(integrator, smooth, curvature, each_cell);
  };
  for_each_block(blocks, ray_grid, inside, [&](const BlockStep& step) {
    const BlockClass& block = blocks.classes[step.block];
    const BlockRange range = records.range(step.block);
    const CurvatureBounds own = records.curvature(step.block);
    if (march.resolves_positions(step.t_end) &&
        integrator.is_smooth(block, range, own, march.variation(own), march.shortest())) {
      curvature = smooth.begin < smooth.end ? join(curvature, own) : own;
      smooth.end = step.t_end;
      if (smooth.end - smooth.begin > march.longest()) {
        finish();
        smooth.begin = smooth.end;
      }
      return !integrator.done();
    }
    finish();
    smooth = {step.t_end, step.t_end};
    if (integrator.done()) return false;
    if (!integrator.try_block(block.kind, range.min, step)) each_cell({step.t_begin, step.t_end});
    return !integrator.done();
  });
  finish();
}

/// Integrates a ray (in grid coordinates, its parameter the world arc length) through trilinear
/// data, within a tolerance; of the ray, the part in `part`. `blocks` belong to the same grid;
/// null: none.
///
/// RayResult::error is at most the tolerance, unless binary32 is forced and cannot keep it, or even
/// binary64 cannot resolve on which side of a discontinuity of the transfer function the data lie.
/// With SingleOnly a ray is left where a cell needs binary64 (RayStatus).
template <bool SingleOnly = false, class Value>
PELLUCID_HD RayResult integrate_ray(const StructuredGrid<Value, double>& grid,
                                    const ClassifiedBlocks* blocks, const Ray<double>& ray_grid,
                                    const TransferTables& transfer, const RayTolerance& wanted,
                                    bool with_depth,
                                    Interval<double> part = HalfOpacity{}.range) noexcept {
  const Interval<double> inside = grid_interval(grid.axis, ray_grid, part);
  if (inside.empty()) return missed_ray_result();

  RayIntegrator<Value, SingleOnly> integrator(grid, ray_grid, transfer, wanted,
                                              inside.end - inside.begin);
  long cells = 0;
  const auto each_cell = [&](Interval<double> range) {
    StructuredWalk<double> walk(grid.axis, ray_grid, range);
    StructuredWalk<double>::Step step;
    while (!integrator.done() && walk.next(step)) {
      ++cells;
      integrator.add_cell(step);
    }
  };
  if (blocks == nullptr) {
    each_cell(inside);
  } else {
    integrate_blocks(*blocks, ray_grid, inside, integrator, each_cell);
  }
  if (integrator.needs_double()) return left_ray_result();
  RayResult result = integrator.result();
  result.cells = cells;
  if (with_depth) {
    result.half_opacity_depth = find_half_opacity(grid, ray_grid, transfer, wanted.precision,
                                                  result.opacity, HalfOpacity{part});
  }
  return result;
}

}  // namespace pellucid
