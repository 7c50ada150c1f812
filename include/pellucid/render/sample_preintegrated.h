// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/field/sample.h"
#include "pellucid/render/ray_result.h"
#include "pellucid/render/sample_ray.h"
#include "pellucid/segment/constant.h"
#include "pellucid/transfer/preintegrated.h"
#include "pellucid/traverse/structured_walk.h"

namespace pellucid {

/// Returns the fraction `part` of a step: the opacity of a constant extinction, and the radiance in
/// proportion to it.
template <class T>
PELLUCID_HD PreintegratedStep<T> partial_step(const PreintegratedStep<T>& whole, T part) noexcept {
  if (!(whole.opacity > T(0))) return {};
  const T opacity = attenuation(-part * log1p(-whole.opacity)).opacity;
  return {opacity, (opacity / whole.opacity) * whole.radiance};
}

/// Marches a ray like sample_ray(), with a table made for this step length. It samples the data at
/// both ends of each step. A step with an end in a cell with a NaN corner is vacuum.
template <class T, class Value>
PELLUCID_HD RayResult sample_preintegrated(const StructuredGrid<Value, double>& grid,
                                           const Ray<double>& ray_grid,
                                           const PreintegratedTable& table, double step,
                                           double largest_color, double stop_tolerance,
                                           bool with_depth) noexcept {
  RayResult result;
  const Interval<double> box = grid_interval(grid.axis, ray_grid);
  if (box.empty()) return result;

  const auto march = [&](auto&& visit) {
    double t_begin = box.begin;
    T front = sample_value<T>(grid, ray_grid.at(t_begin));
    for (long i = 1; t_begin < box.end; ++i) {
      const double t_end = min(box.begin + static_cast<double>(i) * step, box.end);
      const T back = sample_value<T>(grid, ray_grid.at(t_end));
      PreintegratedStep<T> found = preintegrated_step(table, front, back);
      const double part = (t_end - t_begin) / step;
      if (part < 1 - 1e-6) found = partial_step(found, static_cast<T>(part));
      const SegmentResult<T> segment{-log1p(-found.opacity), found.opacity, T(1) - found.opacity,
                                     found.radiance};
      if (!visit(segment, t_begin, t_end)) break;
      front = back;
      t_begin = t_end;
    }
  };

  composite_march<T>(march, stop_tolerance / max(largest_color, 1.0), with_depth, result);
  return result;
}

}  // namespace pellucid
