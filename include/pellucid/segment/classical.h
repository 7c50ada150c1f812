// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/segment/constant.h"
#include "pellucid/transfer/piecewise_linear.h"

/// The classical rules, for comparison: what a sampling renderer does in one step (specification,
/// 3.1, 3.2). Each sees extinction and color at single points of the step, so that its error
/// depends on the step and not on the arithmetic. Orders, in n steps over smooth data, asserted in
/// tests/segment: rectangle and taylor 1; midpoint, trapezoid and simpson 2 (simpson's opacity 4).
namespace pellucid {

/// Left rectangle rule with exponential opacity: 1 - exp(-x), x = extinction · length, at the
/// front.
template <class T>
PELLUCID_HD SegmentResult<T> rectangle_segment(const Material<T>& front, T length) noexcept {
  return constant_segment(front.extinction, front.color, length);
}

/// Max 1995; Weiß 2020, (7) and (10): the exponential to first order, opacity = min(1, x), with
/// radiance = x · color. Beyond x = 1 the radiance is not limited by the opacity: that is the rule.
/// Optical depth here is -log(1 - opacity), infinite from x = 1 on, so that the four members agree.
template <class T>
PELLUCID_HD SegmentResult<T> taylor_segment(const Material<T>& front, T length) noexcept {
  const T x = front.extinction * length;
  const T opacity = min(x, T(1));
  return {-log1p(-opacity), opacity, T(1) - opacity, x * front.color};
}

/// Midpoint rule: extinction and color in the middle of the step.
template <class T>
PELLUCID_HD SegmentResult<T> midpoint_segment(const Material<T>& middle, T length) noexcept {
  return constant_segment(middle.extinction, middle.color, length);
}

/// Average extinction and average color of the ends (specification, 3.2). The opacity is exact
/// where the extinction is linear; the color should have been weighted by it.
template <class T>
PELLUCID_HD SegmentResult<T> average_segment(const Material<T>& front, const Material<T>& back,
                                             T length) noexcept {
  return constant_segment(T(0.5) * front.extinction + T(0.5) * back.extinction,
                          T(0.5) * (front.color + back.color), length);
}

/// The trapezoid rule for the depth and the color: the same as the average.
template <class T>
PELLUCID_HD SegmentResult<T> trapezoid_segment(const Material<T>& front, const Material<T>& back,
                                               T length) noexcept {
  return average_segment(front, back, length);
}

/// Simpson's rule for the optical depth, and the color's mean weighted by Simpson's depths. Fourth
/// order in the opacity; the one color keeps the radiance at second order (specification, 5).
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
