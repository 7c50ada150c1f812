// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/field/multichannel_grid.h"
#include "pellucid/render/ray_result.h"
#include "pellucid/segment/classical.h"
#include "pellucid/segment/compositor.h"
#include "pellucid/segment/gaussian_step.h"
#include "pellucid/segment/linear.h"
#include "pellucid/transfer/multivariate.h"
#include "pellucid/traverse/structured_walk.h"

namespace pellucid {

/// Returns the transparency at which marching ends a ray, per unit of color: far below the accuracy
/// of any of the rules.
template <class T>
PELLUCID_HD constexpr double stop_tolerance() noexcept {
  return is_single<T> ? 1e-6 : 1e-10;
}

/// Rules that march along a ray at a fixed step, for comparison with the exact method. Each samples
/// the data at points only: Max 1995 and Weiß 2020 (rectangle, taylor, midpoint, trapezoid,
/// simpson); linear is Moreland 2004's exact segment between two samples.
enum class SamplingRule { rectangle, taylor, midpoint, trapezoid, simpson, linear };

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

/// Returns one step by a rule, from the materials at its front, middle and back.
template <class T>
PELLUCID_HD SegmentResult<T> sampled_segment(SamplingRule rule, const Material<T>& front,
                                             const Material<T>& middle, const Material<T>& back,
                                             T length) noexcept {
  switch (rule) {
    case SamplingRule::rectangle:
      return rectangle_segment(front, length);
    case SamplingRule::taylor:
      return taylor_segment(front, length);
    case SamplingRule::midpoint:
      return midpoint_segment(middle, length);
    case SamplingRule::trapezoid:
      return trapezoid_segment(front, back, length);
    case SamplingRule::simpson:
      return simpson_segment(front, middle, back, length);
    case SamplingRule::linear:
      break;
  }
  return linear_segment(front.extinction, back.extinction, front.color, back.color, length);
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

/// The positions of a step that a rule samples.
struct SamplePositions {
  bool ends = true, middle = false;
};

/// Marches a ray through `box` at the given step (world length, > 0). sample_at(t) returns the
/// Sample at a position; segment_of(front, middle, back, length) returns the segment of a step,
/// with {} for positions that are not sampled. The last step ends at the box. Positions are
/// multiples of the step from the entry, computed from their index, so that they do not drift.
template <class T, class Sample, class SampleAt, class SegmentOf>
PELLUCID_HD RayResult march_steps(Interval<double> box, SamplePositions seen,
                                  const SampleAt& sample_at, const SegmentOf& segment_of,
                                  double step, double largest_color, double stop_tolerance,
                                  bool with_depth) noexcept {
  RayResult result;
  if (box.empty()) return result;

  const auto march = [&](auto&& visit) {
    double t_begin = box.begin;
    Sample front = seen.ends ? sample_at(t_begin) : Sample{};
    for (long i = 1; t_begin < box.end; ++i) {
      const double t_end = min(box.begin + static_cast<double>(i) * step, box.end);
      const Sample middle = seen.middle ? sample_at(0.5 * (t_begin + t_end)) : Sample{};
      const Sample back = seen.ends ? sample_at(t_end) : Sample{};
      if (!visit(segment_of(front, middle, back, static_cast<T>(t_end - t_begin)), t_begin,
                 t_end)) {
        break;
      }
      front = back;
      t_begin = t_end;
    }
  };

  composite_march<T>(march, stop_tolerance / max(largest_color, 1.0), with_depth, result);
  return result;
}

/// Marches with a rule that uses materials; material_at(t) returns the material at a position.
template <class T, class MaterialAt>
PELLUCID_HD RayResult sample_materials(Interval<double> box, const MaterialAt& material_at,
                                       SamplingRule rule, double step, double largest_color,
                                       double stop_tolerance, bool with_depth) noexcept {
  const SamplePositions seen{rule != SamplingRule::midpoint,
                             rule == SamplingRule::midpoint || rule == SamplingRule::simpson};
  return march_steps<T, Material<T>>(
      box, seen, material_at,
      [&](const Material<T>& front, const Material<T>& middle, const Material<T>& back,
          T length) noexcept { return sampled_segment(rule, front, middle, back, length); },
      step, largest_color, stop_tolerance, with_depth);
}

/// Marches a ray (in grid coordinates, its parameter the world arc length) through the grid's box.
template <class T, class Value>
PELLUCID_HD RayResult sample_ray(const StructuredGrid<Value, double>& grid,
                                 const Ray<double>& ray_grid, const PiecewiseLinear<T>& transfer,
                                 SamplingRule rule, double step, double largest_color,
                                 double stop_tolerance, bool with_depth) noexcept {
  return sample_materials<T>(
      grid_interval(grid.axis, ray_grid),
      [&](double t) noexcept { return sample_material<T>(grid, transfer, ray_grid.at(t)); }, rule,
      step, largest_color, stop_tolerance, with_depth);
}

/// Marches the same ray through several fields.
template <class T>
PELLUCID_HD RayResult sample_multivariate_ray(const MultichannelGrid& grid,
                                              const Ray<double>& ray_grid,
                                              const MultivariateTransfer<T>& transfer,
                                              SamplingRule rule, double step, double largest_color,
                                              double stop_tolerance, bool with_depth) noexcept {
  return sample_materials<T>(
      grid_interval(grid.axis, ray_grid),
      [&](double t) noexcept -> Material<T> {
        T values[max_channels];
        if (!grid.sample(ray_grid.at(t), values)) return {};
        return transfer.evaluate(values);
      },
      rule, step, largest_color, stop_tolerance, with_depth);
}

/// The values of all channels at a position; `filled` is false in vacuum.
template <class T>
struct ChannelSample {
  T value[max_channels]{};
  bool filled = false;
};

/// Marches like Kniss et al. 2003: the data of a step are taken as linear between its ends, and the
/// depth of each term is computed along that line (segment/gaussian_step.h). A step with an end in
/// a cell with a NaN corner is vacuum.
template <class T>
PELLUCID_HD RayResult sample_linear_steps(const MultichannelGrid& grid, const Ray<double>& ray_grid,
                                          const MultivariateTransfer<T>& transfer,
                                          GaussianRule rule, double step, double largest_color,
                                          double stop_tolerance, bool with_depth) noexcept {
  using Sample = ChannelSample<T>;
  return march_steps<T, Sample>(
      grid_interval(grid.axis, ray_grid), SamplePositions{},
      [&](double t) noexcept {
        Sample here;
        here.filled = grid.sample(ray_grid.at(t), here.value);
        return here;
      },
      [&](const Sample& front, const Sample&, const Sample& back,
          T length) noexcept -> SegmentResult<T> {
        if (!front.filled || !back.filled) return {};
        return mean_color_segment(rule, transfer, front.value, back.value, length);
      },
      step, largest_color, stop_tolerance, with_depth);
}

}  // namespace pellucid
