// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/error/bounds.h"
#include "pellucid/error/grade.h"
#include "pellucid/segment/bounded.h"
#include "pellucid/segment/constant.h"
#include "pellucid/transfer/antiderivative.h"

namespace pellucid {

/// A span of a ray, across any number of cells, with data known at its ends and its middle and a
/// bound on their deviation from the chords between these.
template <class T>
struct Stride {
  T front, middle, back;  ///< data values
  T length;
  /// |data - chord| <= this on either half; its mean over a half is at most half of it.
  T deviation;
};

/// Largest factor by which an estimate may be below the proved bound. It limits the trust in data
/// that look smooth at three points and are not.
template <class T>
inline constexpr scalar_t<T> stride_guard = scalar_t<T>(4);

namespace detail {

/// Returns the means of extinction and of extinction · color over data that are linear from a to b.
template <class T>
PELLUCID_HD RangeIntegrals<T> line_means(const PiecewiseLinear<T>& table,
                                         const PiecewiseLinearAntiderivative<T>& antiderivative,
                                         T a, T b) noexcept {
  const ValueRange<T> range(table, min(a, b), max(a, b));
  RangeIntegrals<T> mean;
  if (!(range.last > range.first)) {
    add_stretch(mean, T(1), table.evaluate_in(range.first, a), table.evaluate_in(range.first, b));
    return mean;
  }
  mean = range_integrals(table, antiderivative, range);
  const T width = range.upper - range.lower;
  return {mean.mass / width, (T(1) / width) * mean.emission};
}

/// Returns the segment of half a stride with its depth-weighted mean color, including the error by
/// (5). `depth_error` and `color_error` are the errors of the depth and of that mean.
template <class T>
PELLUCID_HD BoundedSegment<T> stride_half(T depth, const Rgb<T>& color, T depth_error,
                                          T color_error, T color_range) noexcept {
  if (!(depth > T(0))) {
    BoundedSegment<T> nothing;
    nothing.opacity_error = min(depth_error, T(1));
    return nothing;
  }
  BoundedSegment<T> half{segment_of_depth(depth, color)};
  // |e^-a - e^-b| <= e^-min(a,b) |a - b|.
  half.opacity_error = min(depth_error * exp(min(depth_error - depth, T(0))), T(1));
  half.color_error =
      half.segment.opacity *
      min(color_range * mean_color_bound(depth + depth_error) + color_error, color_range);
  return half;
}

}  // namespace detail

/// Integrates a stride along its two chords by the antiderivatives of the transfer function.
/// Returns false if it is not accurate enough: if color_error + largest_color · opacity_error would
/// be above allowance(opacity).
///
/// Proved bound: with the largest |slope| S of the extinction over the values that the data can
/// have, and the deviation δ, the depth of a half of length l has an error of at most l min(S δ/2,
/// V δ/k), with the variation V of the extinction and the change k of value along the chord ((a),
/// (b) in segment/line_error.h). The mean color has an error of (ω S + S_c) δ/2 over the mean
/// extinction, with the range ω of colors and the largest extinction · |color'| S_c; and (5).
///
/// Estimate, but at least the proved bound over stride_guard: the chord of the whole stride against
/// those of the halves. A third of their difference is subtracted (Richardson), and the same amount
/// is charged as the error: it is the error for one kink of the data at a random position, and half
/// of the error in the worst case.
template <class T, class Allowance>
PELLUCID_HD bool integrate_stride(const Stride<T>& stride, const PiecewiseLinear<T>& table,
                                  const PiecewiseLinearAntiderivative<T>& antiderivative,
                                  T largest_color, Grade grade, Allowance&& allowance,
                                  BoundedSegment<T>& result) noexcept {
  const T f = stride.front, m = stride.middle, b = stride.back;
  if (is_nan(f) || is_nan(m) || is_nan(b)) return false;
  const ValueRange<T> reach(table, min(f, min(m, b)) - stride.deviation,
                            max(f, max(m, b)) + stride.deviation);
  const RangeSummary<T> all = range_summary(table, antiderivative, reach);
  result = {};
  if (!all.absorbs()) return true;
  const T half = T(0.5) * stride.length;
  const T slope = max(abs(all.slope_min), abs(all.slope_max));
  const T color_range = all.color_range();
  const T mean_deviation = T(0.5) * stride.deviation;
  const auto depth_bound = [&](T from, T to) noexcept {
    const T change = abs(to - from);
    const T crossing = stride.deviation < change ? stride.deviation / change : T(1);
    return half * min(slope * mean_deviation, all.variation * crossing);
  };
  const RangeIntegrals<T> first = detail::line_means(table, antiderivative, f, m),
                          second = detail::line_means(table, antiderivative, m, b);
  const T depth_1 = half * first.mass, depth_2 = half * second.mass;
  const T error_1 = depth_bound(f, m), error_2 = depth_bound(m, b);
  const T emission_error = (color_range * slope + all.color_slope) * mean_deviation;
  const auto color_of = [&](const RangeIntegrals<T>& mean) noexcept {
    return mean.mass > T(0) ? (T(1) / mean.mass) * mean.emission : all.color_min;
  };
  const Rgb<T> color_1 = color_of(first), color_2 = color_of(second);
  const auto color_error = [&](const RangeIntegrals<T>& mean) noexcept {
    return mean.mass > T(0) ? emission_error / mean.mass : color_range;
  };
  const auto cost = [&](const BoundedSegment<T>& s) noexcept {
    return s.color_error + largest_color * s.opacity_error;
  };
  result =
      compose(detail::stride_half(depth_1, color_1, error_1, color_error(first), color_range),
              detail::stride_half(depth_2, color_2, error_2, color_error(second), color_range));
  const T bound = cost(result), allowed = allowance(result.segment.opacity);
  if (bound <= allowed) return true;
  if (grade == Grade::proved || !(bound <= T(stride_guard<T>) * allowed)) return false;

  const RangeIntegrals<T> whole = detail::line_means(table, antiderivative, f, b);
  const T fine = depth_1 + depth_2;
  const T depth_step = T(1.0 / 3) * (fine - stride.length * whole.mass);
  const T depth = fine + depth_step;
  if (!(fine > T(0)) || !(depth > T(0))) return false;
  const Rgb<T> fine_emission = half * (first.emission + second.emission);
  const Rgb<T> emission_step = T(1.0 / 3) * (fine_emission - stride.length * whole.emission);
  const Rgb<T> shift =
      (T(1) / depth) * (fine_emission + emission_step) - (T(1) / fine) * fine_emission;
  const Rgb<T> color = (T(1) / depth) * (fine_emission + emission_step);
  const T estimated_depth = T(0.5) * abs(depth_step), scale = depth / fine;
  const T estimated_color = largest_component(emission_step - depth_step * color) / depth;
  const auto hull = [&](const Rgb<T>& c) noexcept {
    return Rgb<T>{clamp(c.r, all.color_min.r, all.color_max.r),
                  clamp(c.g, all.color_min.g, all.color_max.g),
                  clamp(c.b, all.color_min.b, all.color_max.b)};
  };
  // Both halves carry their share of twice |depth_step|, in all.
  result = compose(detail::stride_half(depth_1 * scale, hull(color_1 + shift), estimated_depth,
                                       estimated_color, color_range),
                   detail::stride_half(depth_2 * scale, hull(color_2 + shift), estimated_depth,
                                       estimated_color, color_range));
  // A difference that happens to vanish says little.
  result.color_error =
      max(result.color_error, bound / T(stride_guard<T>) - largest_color * result.opacity_error);
  result.proved = false;
  return cost(result) <= min(allowed, allowance(result.segment.opacity));
}

}  // namespace pellucid
