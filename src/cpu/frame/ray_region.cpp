// SPDX-License-Identifier: Apache-2.0
#include "pellucid/cpu/ray_region.h"

#include <algorithm>
#include <limits>

namespace pellucid {

Interval<double> RayRegion::range(const Ray<double>& ray) const noexcept {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr Interval<double> nothing{infinity, -infinity};
  Interval<double> range{0, infinity};
  for (const HalfSpace& half : half_spaces) {
    const double height = dot(half.normal, ray.origin) - half.offset;
    const double slope = dot(half.normal, ray.direction);
    if (slope == 0) {
      if ((height >= 0) != half.above) return nothing;
      continue;
    }
    const double t = -height / slope;
    // Beyond t the ray is above if it rises.
    if ((slope > 0) == half.above) {
      range.begin = std::max(range.begin, t);
    } else {
      range.end = std::min(range.end, t);
    }
  }
  return range.begin < range.end ? range : nothing;
}

}  // namespace pellucid
