// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "pellucid/geometry/box.h"

namespace pellucid {

/// Widens a box so that it holds a point.
template <class T>
constexpr void include(Box<T>& box, const Vec3<T>& point) noexcept {
  for (int a = 0; a < 3; ++a) {
    if (point[a] < box.lower[a]) box.lower[a] = point[a];
    if (point[a] > box.upper[a]) box.upper[a] = point[a];
  }
}

/// Returns a box without points, for include().
template <class T>
constexpr Box<T> empty_box() noexcept {
  constexpr T infinity = std::numeric_limits<T>::infinity();
  return {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
}

/// Returns the least box along the axes that holds some points, at least one.
template <class Points>
constexpr auto box_around(const Points& points) noexcept {
  Box<decltype(points[0].x)> box{points[0], points[0]};
  for (const auto& point : points) include(box, point);
  return box;
}

}  // namespace pellucid
