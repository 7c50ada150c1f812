// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/geometry/vec3.h"

namespace pellucid {

/// Bounds, rounded upward, on how fast the derivative of the data of one block changes. Infinite
/// where the block has vacuum.
struct CurvatureBounds {
  /// Along each axis, the largest jump of the derivative by that axis's grid coordinate across a
  /// plane of cells: those inside of the block and its upper face (the lower is its neighbour's).
  float second_difference[3];
  /// The largest mixed derivative inside of a cell: by y and z, z and x, x and y.
  float twist[3];
};

/// Returns a bound on how much the data's derivative by t varies, in all, along a stretch of a ray:
/// inside of one block, or of several one behind the other whose bends are joined by their maximum.
///
/// Inside of a cell the trilinear data have no second derivative along an axis, so that along the
/// direction d it is 2 Σ d_a d_b twist_ab. Across a plane of axis a the derivative jumps by d_a
/// times that by a, which is bilinear on the face: at most its largest corner. A stretch of this
/// length meets at most |d_a| length / (least width) + 1 planes of the axis.
///
/// `speed`: |d_a|; `planes`: how many of each axis are met at most. Axes along which nothing moves
/// do not count, even where what is said of them is unbounded. T: double, or a number of several
/// rays at once.
template <class T>
PELLUCID_HD T derivative_variation(const T (&second_difference)[3], const T (&twist)[3],
                                   const T (&speed)[3], const T (&planes)[3], T length) noexcept {
  T sum(0);
  for (int a = 0; a < 3; ++a) {
    const T both = speed[(a + 1) % 3] * speed[(a + 2) % 3];
    sum += select(both > T(0), T(2) * length * (both * twist[a]), T(0));
    sum += select(speed[a] > T(0), speed[a] * planes[a] * second_difference[a], T(0));
  }
  return sum * T(1 + 32 * rounding_unit<T>);
}
PELLUCID_HD inline double derivative_variation(const CurvatureBounds& curvature,
                                               Vec3<double> direction, Vec3<double> least_width,
                                               double length) noexcept {
  double second_difference[3], twist[3], speed[3], planes[3];
  for (int a = 0; a < 3; ++a) {
    second_difference[a] = static_cast<double>(curvature.second_difference[a]);
    twist[a] = static_cast<double>(curvature.twist[a]);
    speed[a] = abs(direction[a]);
    planes[a] = speed[a] * length / least_width[a] + 1;
  }
  return derivative_variation(second_difference, twist, speed, planes, length);
}

/// Returns a bound on the distance from the chord of a stretch of data whose derivative varies by
/// `variation` in all:
///
///   |f(t) - chord(t)| <= length · (B - m)(m - A) / (B - A) <= length · (B - A) / 4,
///
/// A and B being the ends of the derivative's range and m the chord's slope; B - A is at most the
/// variation. For the difference g vanishes at both ends and its derivative f' - m lies in [A - m,
/// B - m]: from the front g(t) <= (B - m) t, from the back g(t) <= (m - A)(length - t); the smaller
/// of the two is largest where they meet, at (B - m)(m - A) / (B - A) · length. The same of -g. No
/// m in [A, B] makes this larger than its value at (A + B) / 2. The mean of the distance is at most
/// half of it.
PELLUCID_HD inline double bend_deviation(double variation, double length) noexcept {
  return 0.25 * length * variation;
}

PELLUCID_HD inline CurvatureBounds join(const CurvatureBounds& p,
                                        const CurvatureBounds& q) noexcept {
  CurvatureBounds result;
  for (int a = 0; a < 3; ++a) {
    result.second_difference[a] = max(p.second_difference[a], q.second_difference[a]);
    result.twist[a] = max(p.twist[a], q.twist[a]);
  }
  return result;
}

}  // namespace pellucid
