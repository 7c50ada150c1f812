// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "pellucid/scene/unstructured_grid.h"

namespace pellucid {

using Triangle = std::array<std::int32_t, 3>;

/// What tetrahedra are together, found without their neighbours. With coordinates that are integers
/// below 2^15 all numbers here are exact.
struct TetrahedraCheck {
  std::map<Triangle, int> faces;  ///< corners in ascending order: how many tetrahedra have it
  std::set<std::array<std::int32_t, 2>> edges;
  std::set<std::int32_t> points;
  double six_volumes = 0;  ///< six times the sum of the volumes
  double smallest = 0;     ///< six times the smallest volume
  std::size_t tetrahedra = 0;

  explicit TetrahedraCheck(const UnstructuredGrid& grid) : tetrahedra(grid.corners.size() / 4) {
    for (std::size_t t = 0; t < tetrahedra; ++t) {
      std::array<std::int32_t, 4> c;
      std::copy_n(grid.corners.begin() + static_cast<std::ptrdiff_t>(4 * t), 4, c.begin());
      const auto at = [&](std::size_t i) { return grid.points[static_cast<std::size_t>(c[i])]; };
      const Vec3<double> o = at(0);
      const double volume = std::abs(dot(at(1) - o, cross(at(2) - o, at(3) - o)));
      six_volumes += volume;
      smallest = t == 0 ? volume : std::min(smallest, volume);

      std::ranges::sort(c);
      points.insert(c.begin(), c.end());
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = i + 1; j < 4; ++j) edges.insert({c[i], c[j]});
      }
      ++faces[{c[1], c[2], c[3]}];
      ++faces[{c[0], c[2], c[3]}];
      ++faces[{c[0], c[1], c[3]}];
      ++faces[{c[0], c[1], c[2]}];
    }
  }

  std::vector<Triangle> boundary() const {
    std::vector<Triangle> single;
    for (const auto& [face, count] : faces) {
      if (count == 1) single.push_back(face);
    }
    return single;
  }
  bool crowded() const {
    return std::ranges::any_of(faces, [](const auto& face) { return face.second > 2; });
  }
  /// 1 for a ball.
  std::ptrdiff_t euler_characteristic() const {
    return static_cast<std::ptrdiff_t>(points.size()) - static_cast<std::ptrdiff_t>(edges.size()) +
           static_cast<std::ptrdiff_t>(faces.size()) - static_cast<std::ptrdiff_t>(tetrahedra);
  }
};

/// The triangles of a quadrilateral cut at its point of the smallest index, corners ascending.
inline std::array<Triangle, 2> cut_at_smallest(std::array<std::int32_t, 4> q) {
  std::rotate(q.begin(), std::ranges::min_element(q), q.end());
  std::array<Triangle, 2> cut{Triangle{q[0], q[1], q[2]}, Triangle{q[0], q[2], q[3]}};
  for (Triangle& t : cut) std::ranges::sort(t);
  return cut;
}

}  // namespace pellucid
