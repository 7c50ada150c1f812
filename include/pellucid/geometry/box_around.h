// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/geometry/box.h"

namespace pellucid {

/// Returns the least box along the axes that holds some points, at least one.
template <class Points>
constexpr auto box_around(const Points& points) noexcept {
  Box box{points[0], points[0]};
  for (const auto& point : points) {
    for (int a = 0; a < 3; ++a) {
      if (point[a] < box.lower[a]) box.lower[a] = point[a];
      if (point[a] > box.upper[a]) box.upper[a] = point[a];
    }
  }
  return box;
}

}  // namespace pellucid
