// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/geometry/ray.h"

namespace pellucid {

/// A 3×3 matrix by its columns, the images of the three axes.
template <class T>
struct Mat3 {
  Vec3<T> column[3]{{T(1), T(0), T(0)}, {T(0), T(1), T(0)}, {T(0), T(0), T(1)}};

  PELLUCID_HD friend constexpr Vec3<T> operator*(const Mat3& m, Vec3<T> v) noexcept {
    return m.column[0] * v.x + m.column[1] * v.y + m.column[2] * v.z;
  }
  friend constexpr bool operator==(const Mat3&, const Mat3&) noexcept = default;
};

template <class T>
PELLUCID_HD constexpr T determinant(const Mat3<T>& m) noexcept {
  return dot(m.column[0], cross(m.column[1], m.column[2]));
}

/// Returns the inverse by the adjugate. Precondition: the determinant is not 0.
template <class T>
PELLUCID_HD constexpr Mat3<T> inverse(const Mat3<T>& m) noexcept {
  const Vec3<T> r0 = cross(m.column[1], m.column[2]);
  const Vec3<T> r1 = cross(m.column[2], m.column[0]);
  const Vec3<T> r2 = cross(m.column[0], m.column[1]);
  const T d = dot(m.column[0], r0);
  return {{{r0.x / d, r1.x / d, r2.x / d},
           {r0.y / d, r1.y / d, r2.y / d},
           {r0.z / d, r1.z / d, r2.z / d}}};
}

/// position_to = matrix · position_from + translation.
template <class T>
struct Affine {
  Mat3<T> matrix;
  Vec3<T> translation;

  /// Maps a point.
  PELLUCID_HD constexpr Vec3<T> point(Vec3<T> p) const noexcept { return matrix * p + translation; }
  /// Maps a direction.
  PELLUCID_HD constexpr Vec3<T> vector(Vec3<T> v) const noexcept { return matrix * v; }
  /// Maps a ray; its parameter t stays the same.
  PELLUCID_HD constexpr Ray<T> ray(const Ray<T>& r) const noexcept {
    return {point(r.origin), vector(r.direction)};
  }
  friend constexpr bool operator==(const Affine&, const Affine&) noexcept = default;
};

template <class T>
PELLUCID_HD constexpr Affine<T> inverse(const Affine<T>& a) noexcept {
  const Mat3<T> m = inverse(a.matrix);
  return {m, -(m * a.translation)};
}

}  // namespace pellucid
