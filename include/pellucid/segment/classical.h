// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/segment/constant.h"
#include "pellucid/transfer/piecewise_linear.h"

/// The classical rules, for comparison: one step of a sampling renderer (specification, 3.1, 3.2).
/// Each uses extinction and color at single points of the step, so that its error depends on the
/// step and not on the arithmetic. Orders in n steps over smooth data, asserted in tests/segment:
/// rectangle and taylor 1; midpoint, trapezoid and simpson 2 (simpson's opacity 4).
namespace pellucid {

/// Returns the left rectangle rule with exponential opacity: 1 - exp(-x), x = extinction · length
/// at the front.
template <class T>
PELLUCID_HD SegmentResult<T> rectangle_segment(const Material<T>& front, T length) noexcept {
  return constant_segment(front.extinction, front.color, length);
}

/// Returns the rule with the exponential to first order (Max 1995; Weiß 2020, (7) and (10)):
/// opacity = min(1, x), radiance = x · color. Beyond x = 1 the rule does not limit the radiance by
/// the opacity. The optical depth is -log(1 - opacity), infinite from x = 1 on, so that the four
/// members are consistent.
template <class T>
PELLUCID_HD SegmentResult<T> taylor_segment(const Material<T>& front, T length) noexcept {
  const T x = front.extinction * length;
  const T opacity = min(x, T(1));
  return {-log1p(-opacity), opacity, T(1) - opacity, x * front.color};
}

/// Returns the midpoint rule: extinction and color in the middle of the step.
template <class T>
PELLUCID_HD SegmentResult<T> midpoint_segment(const Material<T>& middle, T length) noexcept {
  return constant_segment(middle.extinction, middle.color, length);
}

/// Returns the segment with the mean extinction and the mean color of the ends (specification,
/// 3.2). The opacity is exact for linear extinction; the color should be weighted by the
/// extinction.
template <class T>
PELLUCID_HD SegmentResult<T> average_segment(const Material<T>& front, const Material<T>& back,
                                             T length) noexcept {
  return constant_segment(T(0.5) * front.extinction + T(0.5) * back.extinction,
                          T(0.5) * (front.color + back.color), length);
}

/// Returns the trapezoid rule for depth and color, which is the same as average_segment().
template <class T>
PELLUCID_HD SegmentResult<T> trapezoid_segment(const Material<T>& front, const Material<T>& back,
                                               T length) noexcept {
  return average_segment(front, back, length);
}

/// Returns Simpson's rule for the optical depth, with the mean color weighted by Simpson's depths.
/// The opacity is of fourth order; the single color limits the radiance to second order
/// (specification, 5).
template <class T>
PELLUCID_HD SegmentResult<T> simpson_segment(const Material<T>& front, const Material<T>& middle,
                                             const Material<T>& back, T length) noexcept {
  constexpr scalar_t<T> sixth = scalar_t<T>(1) / scalar_t<T>(6);
  constexpr scalar_t<T> two_thirds = scalar_t<T>(2) / scalar_t<T>(3);
  const T x_f = front.extinction * sixth, x_m = middle.extinction * two_thirds,
          x_b = back.extinction * sixth;
  const T mean = x_f + x_m + x_b;
  // Vacuum: any color will do. The quotients are formed first: a color times an extinction may
  // overflow.
  const T divisor = select(mean > T(0), mean, T(1));
  const Rgb<T> color =
      (x_f / divisor) * front.color + (x_m / divisor) * middle.color + (x_b / divisor) * back.color;
  return constant_segment(mean, color, length);
}

}  // namespace pellucid
