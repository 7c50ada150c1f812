// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/geometry/vec3.h"

namespace pellucid {

/// origin + t · direction. With a direction of length 1 in world space, t is the arc length in
/// world units. It remains so when an affine map carries the ray into grid coordinates, where the
/// direction has another length.
template <class T>
struct Ray {
  Vec3<T> origin;
  Vec3<T> direction;

  PELLUCID_HD constexpr Vec3<T> at(T t) const noexcept { return origin + direction * t; }
};

/// t in [begin, end]; empty where begin > end.
template <class T>
struct Interval {
  T begin, end;

  PELLUCID_HD constexpr bool empty() const noexcept { return !(begin <= end); }
};

}  // namespace pellucid
