// SPDX-License-Identifier: Apache-2.0
#include "orientation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pellucid::cli {

Orientation anatomical_orientation(const Mat3<double>& direction) {
  constexpr char towards[3][2] = {{'L', 'R'}, {'P', 'A'}, {'S', 'I'}};
  Orientation orientation{"???", 0};
  bool axis_named[3] = {}, world_taken[3] = {};
  for (int round = 0; round < 3; ++round) {
    int best_axis = -1, best_world = -1;
    double best_cosine = -1;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3<double> unit = normalized(direction.column[axis]);
      for (int world = 0; world < 3; ++world) {
        if (axis_named[axis] || world_taken[world]) continue;
        if (std::abs(unit[world]) > best_cosine) {
          best_cosine = std::abs(unit[world]);
          best_axis = axis;
          best_world = world;
        }
      }
    }
    axis_named[best_axis] = world_taken[best_world] = true;
    const bool backwards = direction.column[best_axis][best_world] < 0;
    orientation.code[static_cast<std::size_t>(best_axis)] = towards[best_world][backwards ? 1 : 0];
    const double angle = std::acos(std::min(best_cosine, 1.0)) * 180 / std::numbers::pi;
    orientation.oblique_by = std::max(orientation.oblique_by, angle);
  }
  return orientation;
}

}  // namespace pellucid::cli
