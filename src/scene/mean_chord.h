// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "pellucid/geometry/box.h"
#include "pellucid/scene/volume.h"

namespace pellucid {

/// Returns the mean length of the chords of the volume's box: 4 · volume / surface (Cauchy).
inline double mean_chord(const Volume& volume) {
  const Vec3<double> size = volume.grid_upper() - volume.grid_lower();
  const Mat3<double>& axes = volume.world_from_grid().matrix;
  const Vec3<double> a = axes.column[0] * size.x, b = axes.column[1] * size.y,
                     c = axes.column[2] * size.z;
  const double surface = 2 * (length(cross(a, b)) + length(cross(b, c)) + length(cross(c, a)));
  return 4 * std::abs(dot(a, cross(b, c))) / surface;
}

/// Returns the same of a box along the axes.
inline double mean_chord(const Box<double>& box) {
  const Vec3<double> size = box.upper - box.lower;
  return 2 * size.x * size.y * size.z / (size.x * size.y + size.y * size.z + size.z * size.x);
}

}  // namespace pellucid
