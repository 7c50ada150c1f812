// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/expm1_quotient_to_4.h"
#include "pellucid/segment/constant.h"
#include "pellucid/transfer/piecewise_linear.h"

namespace pellucid {

/// A span of four steps of equal length, and its difference from two steps of twice the length.
template <class T>
struct SampledSegment {
  SegmentResult<T> segment;
  T difference;  ///< the largest of opacity and the channels of radiance
};

/// Sample at the end of a step: extinction, and emission, which is extinction · color.
template <class T>
struct StepEnd {
  T extinction;
  Rgb<T> emission;

  void add(T more, const Rgb<T>& color) noexcept {
    extinction += more;
    emission += more * color;
  }
};

namespace detail {

/// Returns the trapezoidal rule: the mean of the ends' extinctions, and of their colors weighted by
/// these.
template <class T>
SegmentResult<T> trapezoid(const StepEnd<T>& front, const StepEnd<T>& back, T length) noexcept {
  const T half = T(0.5) * length, depth = half * (front.extinction + back.extinction);
  const T mean_transparency = expm1_quotient_to_4(min(T(0.25) * depth, T(1))),
          opacity = depth * mean_transparency;
  return {depth, opacity, T(1) - opacity,
          (half * mean_transparency) * (front.emission + back.emission)};
}

/// Returns two steps improved by Richardson extrapolation with the same span as one step, which
/// cancels the error of the trapezoidal rule in h².
template <class T>
SegmentResult<T> improve(const SegmentResult<T>& first, const SegmentResult<T>& second,
                         const SegmentResult<T>& as_one) noexcept {
  const auto improved = [](T fine, T coarse) noexcept {
    return max(fine + T(scalar_t<T>(1.0 / 3)) * (fine - coarse), T(0));
  };
  const T t = first.transparency;
  SegmentResult<T> r;
  r.optical_depth = improved(first.optical_depth + second.optical_depth, as_one.optical_depth);
  r.opacity = min(improved(first.opacity + t * second.opacity, as_one.opacity), T(1));
  r.transparency = T(1) - r.opacity;
  r.radiance = {improved(first.radiance.r + t * second.radiance.r, as_one.radiance.r),
                improved(first.radiance.g + t * second.radiance.g, as_one.radiance.g),
                improved(first.radiance.b + t * second.radiance.b, as_one.radiance.b)};
  return r;
}

}  // namespace detail

/// Returns the segment of four steps of this length from the samples at their five ends. It is in
/// effect Simpson's rule; `difference` compares it with the rule at twice the step length. For
/// smooth data the segment's own error is a small fraction of `difference` (a sixteenth in the
/// limit), and less than it for data with kinks at positions unknown to the samples. tests/segment
/// compares it with quadrature.
///
/// Limitations: not accurate to the last digits if the opacity is small; meant for a span among
/// others of a ray. length · largest extinction must be at most 1; otherwise the result is finite
/// but meaningless.
template <class T>
SampledSegment<T> sampled_segment(const StepEnd<T>* end, T length) noexcept {
  const T two = T(2) * length;
  const SegmentResult<T> first = detail::trapezoid(end[0], end[2], two),
                         second = detail::trapezoid(end[2], end[4], two);
  const SegmentResult<T> p = detail::improve(detail::trapezoid(end[0], end[1], length),
                                             detail::trapezoid(end[1], end[2], length), first),
                         q = detail::improve(detail::trapezoid(end[2], end[3], length),
                                             detail::trapezoid(end[3], end[4], length), second);
  const SegmentResult<T> coarse =
      detail::improve(first, second, detail::trapezoid(end[0], end[4], T(4) * length));
  SampledSegment<T> r;
  SegmentResult<T>& s = r.segment;
  s.optical_depth = p.optical_depth + q.optical_depth;
  s.opacity = p.opacity + p.transparency * q.opacity;
  s.transparency = p.transparency * q.transparency;
  s.radiance = p.radiance + p.transparency * q.radiance;
  r.difference =
      max(max(abs(s.opacity - coarse.opacity), abs(s.radiance.r - coarse.radiance.r)),
          max(abs(s.radiance.g - coarse.radiance.g), abs(s.radiance.b - coarse.radiance.b)));
  return r;
}

/// Returns the same from five materials.
template <class T>
SampledSegment<T> sampled_segment(const Material<T>* at, T length) noexcept {
  StepEnd<T> end[5];
  for (int i = 0; i < 5; ++i) end[i] = {at[i].extinction, at[i].extinction * at[i].color};
  return sampled_segment(end, length);
}

}  // namespace pellucid
