// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "walk_check.h"

namespace pellucid {

/// Random grids and rays, with what is rare at random made common: planes, edges and vertices hit
/// exactly, directions of ±0, denormal or equal components, origins inside, on planes and far away.
template <class T>
class WalkGenerator {
 public:
  /// Up to most_values data values along an axis, one more where they are points.
  explicit WalkGenerator(int most_values = 7) : most_values_(most_values) {}

  TestGrid<T> grid() {
    TestGrid<T> g;
    for (int a = 0; a < 3; ++a) {
      const int padding = pick(2);
      const int values = 1 + pick(most_values_) + (padding == 0 ? 1 : 0);
      if (pick(3) > 0) {
        g.set_uniform(a, values, padding);
        continue;
      }
      std::vector<T> planes{static_cast<T>(10 * uniform() - 5)};
      for (int i = 1; i < values + 2 * padding; ++i) {
        // Widths from a rounding error to far more than the others.
        const T width = static_cast<T>(std::pow(10, 3 * uniform() - 2));
        planes.push_back(pick(8) == 0 ? std::nextafter(planes.back(), T(1e9))
                                      : planes.back() + width);
      }
      g.set_planes(a, planes, padding);
    }
    return g;
  }

  Ray<T> ray(const TestGrid<T>& g) {
    Ray<T> r;
    const Vec3<T> target = point(g);
    switch (pick(4)) {
      case 0: {  // from a point of the grid to another
        r.origin = point(g);
        r.direction = target - r.origin;
        break;
      }
      case 1: {  // from outside, near or far
        const double distance = std::pow(10, 1 + (pick(3) == 0 ? 8 : 1) * uniform());
        for (int a = 0; a < 3; ++a) {
          r.origin[a] = static_cast<T>(distance * (2 * uniform() - 1));
        }
        r.direction = target - r.origin;
        if (pick(2) == 0) r.direction = normalized(r.direction);
        break;
      }
      case 2: {  // small whole numbers: diagonals, edges, vertices, faces
        for (int a = 0; a < 3; ++a) r.direction[a] = static_cast<T>(pick(5) - 2);
        r.origin = target - static_cast<T>(pick(10)) * r.direction;
        break;
      }
      default: {
        for (int a = 0; a < 3; ++a) r.direction[a] = static_cast<T>(2 * uniform() - 1);
        r.origin = target - static_cast<T>(20 * uniform()) * r.direction;
      }
    }
    for (int a = 0; a < 3; ++a) {
      const int kind = pick(16);
      if (kind == 0) r.direction[a] = T(0);
      if (kind == 1) r.direction[a] = -T(0);
      if (kind == 2)
        r.direction[a] = static_cast<T>(pick(7) - 3) * std::numeric_limits<T>::denorm_min();
      if (kind == 3) r.direction[a] *= static_cast<T>(1e-10);
      if (kind < 4 && pick(2) == 0) r.origin[a] = target[a];  // so that the ray still hits
    }
    return r;
  }

  int pick(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
  double uniform() { return std::uniform_real_distribution<double>(0, 1)(random_); }

 private:
  /// Somewhere in the box; each coordinate on a plane half of the time.
  Vec3<T> point(const TestGrid<T>& g) {
    Vec3<T> p;
    for (int a = 0; a < 3; ++a) {
      p[a] = pick(2) == 0 ? g.axis[a].plane(pick(g.axis[a].cells() + 1))
                          : g.lower(a) + static_cast<T>(uniform()) * (g.upper(a) - g.lower(a));
    }
    return p;
  }

  int most_values_;
  std::mt19937 random_{11};
};

}  // namespace pellucid
