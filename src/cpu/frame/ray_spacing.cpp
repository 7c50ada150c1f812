// SPDX-License-Identifier: Apache-2.0
#include "ray_spacing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pellucid {
namespace {

/// Largest distance of rays on the box's faces, in longest steps: three of these are a wave of the
/// data. There rays begin and end, so that waves along a face are waves of the picture, however
/// much shorter for being seen at a grazing angle; CubicErrors hold for 2.25 pixels of the lattice
/// a wave and more.
constexpr double most_along_face = 3 / 2.25;

}  // namespace

RaySpacing::RaySpacing(const BlockRecords& records) noexcept {
  for (int a = 0; a < 3; ++a) {
    least_[a] = records.axis[a].plane(0);
    most_[a] = records.axis[a].plane(records.axis[a].cells());
  }
}

float RaySpacing::operator()(const PellucidRay& ray) const noexcept {
  return static_cast<float>(std::min(most, most_along_face * facing(ray)));
}

/// Returns the cosine between a ray and the normal, in cells, of the more slanted of the two faces
/// at which it enters and leaves the box. Infinite where it does not meet any.
double RaySpacing::facing(const PellucidRay& ray) const noexcept {
  double entry = 0, exit = std::numeric_limits<double>::infinity(), square = 0;
  double of_entry = std::numeric_limits<double>::infinity(), of_exit = of_entry;
  for (int a = 0; a < 3; ++a) {
    const double d = ray.direction[a];
    square += d * d;
    if (d == 0) continue;
    const double in = ((d > 0 ? least_[a] : most_[a]) - ray.origin[a]) / d,
                 out = ((d > 0 ? most_[a] : least_[a]) - ray.origin[a]) / d;
    if (in > entry) {
      entry = in;
      of_entry = std::fabs(d);
    }
    if (out < exit) {
      exit = out;
      of_exit = std::fabs(d);
    }
  }
  return std::min(of_entry, of_exit) / std::sqrt(square);
}

}  // namespace pellucid
