// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "pellucid/geometry/box.h"

namespace pellucid {

/// Returns the interval at t >= 0 of a ray inside a box, and beside it far beyond rounding.
inline Interval<double> interval_near(const Box<double>& box, double largest_coordinate,
                                      const Ray<double>& ray) {
  const double beside = 1e-9 * (largest_coordinate + length(box.upper - box.lower));
  const Vec3<double> wider{beside, beside, beside};
  const Interval<double> inside = intersect(Box<double>{box.lower - wider, box.upper + wider}, ray);
  return {std::max(inside.begin, 0.0), inside.end};
}
inline Interval<double> interval_near(const Box<double>& box, const Ray<double>& ray) {
  double largest = 0;
  for (int a = 0; a < 3; ++a) {
    largest = std::max({largest, std::abs(box.lower[a]), std::abs(box.upper[a])});
  }
  return interval_near(box, largest, ray);
}

}  // namespace pellucid
