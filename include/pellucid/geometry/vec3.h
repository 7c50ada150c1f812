// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/scalar.h"

namespace pellucid {

/// A point or a direction in space. The variable's name says which space.
template <class T>
struct Vec3 {
  T x{}, y{}, z{};

  PELLUCID_HD constexpr T operator[](int axis) const noexcept {
    return axis == 0 ? x : axis == 1 ? y : z;
  }
  PELLUCID_HD constexpr T& operator[](int axis) noexcept {
    return axis == 0 ? x : axis == 1 ? y : z;
  }
  PELLUCID_HD friend constexpr Vec3 operator+(Vec3 p, Vec3 q) noexcept {
    return {p.x + q.x, p.y + q.y, p.z + q.z};
  }
  PELLUCID_HD friend constexpr Vec3 operator-(Vec3 p, Vec3 q) noexcept {
    return {p.x - q.x, p.y - q.y, p.z - q.z};
  }
  PELLUCID_HD friend constexpr Vec3 operator-(Vec3 p) noexcept { return {-p.x, -p.y, -p.z}; }
  PELLUCID_HD friend constexpr Vec3 operator*(Vec3 p, T s) noexcept {
    return {p.x * s, p.y * s, p.z * s};
  }
  PELLUCID_HD friend constexpr Vec3 operator*(T s, Vec3 p) noexcept { return p * s; }
  PELLUCID_HD friend constexpr bool operator==(const Vec3& p, const Vec3& q) noexcept {
    return p.x == q.x && p.y == q.y && p.z == q.z;
  }
};

template <class T>
PELLUCID_HD constexpr T dot(Vec3<T> p, Vec3<T> q) noexcept {
  return p.x * q.x + p.y * q.y + p.z * q.z;
}
template <class T>
PELLUCID_HD constexpr Vec3<T> cross(Vec3<T> p, Vec3<T> q) noexcept {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}
template <class T>
PELLUCID_HD inline T length(Vec3<T> p) noexcept {
  return sqrt(dot(p, p));
}
/// Returns p / |p|; NaN for the zero vector.
template <class T>
PELLUCID_HD inline Vec3<T> normalized(Vec3<T> p) noexcept {
  return p * (T(1) / length(p));
}

}  // namespace pellucid
