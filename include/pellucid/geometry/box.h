// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/geometry/ray.h"

namespace pellucid {

/// The closed box lower <= p <= upper.
template <class T>
struct Box {
  Vec3<T> lower, upper;
};

/// Returns the interval of a ray inside a box; empty if it misses.
///
/// Slab method: a plane is met at t = (plane - origin) / direction, which is never NaN because the
/// direction component is not 0; the parameters of the lower and the upper plane are in order
/// whatever the rounding. Along an axis with direction ±0 the ray is entirely inside or outside; a
/// ray in a face is inside. If a component is so small that t overflows, the slab correctly begins
/// or ends at ±infinity; a box entirely at infinity is missed. A ray with a NaN misses.
template <class T>
PELLUCID_HD inline Interval<T> intersect(const Box<T>& box, const Ray<T>& ray) noexcept {
  constexpr T infinity = std::numeric_limits<T>::infinity();
  constexpr Interval<T> nothing{infinity, -infinity};
  Interval<T> t{-infinity, infinity};
  for (int a = 0; a < 3; ++a) {
    const T origin = ray.origin[a], direction = ray.direction[a];
    if (direction == T(0)) {
      if (!(origin >= box.lower[a] && origin <= box.upper[a])) return nothing;
      continue;
    }
    const bool forward = direction > T(0);
    const T t_in = ((forward ? box.lower[a] : box.upper[a]) - origin) / direction;
    const T t_out = ((forward ? box.upper[a] : box.lower[a]) - origin) / direction;
    if (!(t_in <= t_out)) return nothing;
    t = {max(t.begin, t_in), min(t.end, t_out)};
  }
  return t.begin <= t.end && t.begin < infinity && -infinity < t.end ? t : nothing;
}

}  // namespace pellucid
