// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/render/ray_result.h"
#include "pellucid/segment/cubic.h"
#include "pellucid/segment/fold.h"
#include "pellucid/traverse/spans.h"

namespace pellucid {

/// The relative tolerance that each span is integrated to: its error is at most this times its
/// opacity (per unit of color), so that the sum over a ray is at most this, however many cells it
/// crosses (specification, 2.3, corollary). Above the kernels' own rounding in that number type.
template <class T>
PELLUCID_HD constexpr T span_tolerance() noexcept {
  return is_single<T> ? T(1e-5) : T(1e-9);
}

/// Where the walk may end: what lies behind can change a channel by at most the transparency times
/// the largest color (specification, 2.2), and that is kept under a tenth of the spans' tolerance.
template <class T>
PELLUCID_HD constexpr double stop_tolerance() noexcept {
  return 0.1 * static_cast<double>(span_tolerance<T>());
}

/// The world arc length where the optical depth along the ray reaches `target`; infinite where it
/// never does. The depth inside a span is monotone, so that bisection between its ends finds the
/// place; it ends where the parameter no longer changes the arc length in float, which is what an
/// image holds.
template <class T, class Value>
PELLUCID_HD double find_optical_depth(const StructuredGrid<Value, double>& grid,
                                      const Ray<double>& ray_grid,
                                      const PiecewiseLinear<T>& transfer, double target) noexcept {
  double before = 0;
  double found = std::numeric_limits<double>::infinity();
  for_each_span<T>(grid, ray_grid, [&](const CubicSpan<T>& span) {
    const T length = span.length();
    const double inside = static_cast<double>(optical_depth_cubic(span.data, length, transfer));
    if (before + inside < target) {
      before += inside;
      return true;
    }
    double lo = 0, hi = 1;
    for (int i = 0; i < 24; ++i) {
      const double mid = 0.5 * (lo + hi);
      const T u = static_cast<T>(mid);
      const T depth = optical_depth_cubic(restrict_to(span.data, T(0), u), length * u, transfer);
      (before + static_cast<double>(depth) < target ? lo : hi) = mid;
    }
    found = span.t_begin + hi * (span.t_end - span.t_begin);
    return false;
  });
  return found;
}

/// The volume rendering integral along a ray (in grid coordinates, its parameter the world arc
/// length) through trilinear data: cell by cell exact in optical depth, and in radiance within
/// span_tolerance.
template <class T, class Value>
PELLUCID_HD RayResult integrate_ray(const StructuredGrid<Value, double>& grid,
                                    const Ray<double>& ray_grid, const PiecewiseLinear<T>& transfer,
                                    double largest_color, bool with_depth) noexcept {
  RayResult result;
  FrontToBack<double> fold(stop_tolerance<T>() / max(largest_color, 1.0));
  result.cells = for_each_span<T>(grid, ray_grid, [&](const CubicSpan<T>& span) {
    fold.add(integrate_cubic(span.data, span.length(), transfer, span_tolerance<T>()));
    return !fold.done();
  });
  result.radiance = fold.radiance();
  result.optical_depth = fold.optical_depth();
  result.opacity = fold.opacity();
  if (with_depth && result.opacity > 0) {
    // There exp(-a) = 1 - opacity/2.
    result.half_opacity_depth =
        find_optical_depth<T>(grid, ray_grid, transfer, -log1p(-0.5 * result.opacity));
  }
  return result;
}

}  // namespace pellucid
