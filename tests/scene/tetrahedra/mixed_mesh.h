// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "pellucid/scene/unstructured_grid.h"

namespace pellucid {

/// A box of n³ cubes as a conforming mesh of hexahedra, wedges, pyramids and tetrahedra, at random,
/// with its points numbered at random. Points inside are moved a little; all coordinates are
/// multiples of 8.
class MixedMesh {
 public:
  static constexpr int side = 1024;  ///< of a cube

  /// `collapsed`: some cells are hexahedra with collapsed edges instead.
  MixedMesh(int n, unsigned seed, bool collapsed) : n_(n), collapsed_(collapsed), random_(seed) {
    for (int k = 0; k <= n; ++k) {
      for (int j = 0; j <= n; ++j) {
        for (int i = 0; i <= n; ++i) {
          grid_.points.push_back({moved(i), moved(j), moved(k)});
        }
      }
    }
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        // Wedges have triangles below and above: a column of cubes is cut as one.
        const bool wedges = one_in(3);
        for (int k = 0; k < n; ++k) {
          const std::array<std::int32_t, 8> cube = corners(i, j, k);
          if (wedges) {
            add_wedge({cube[0], cube[1], cube[2], cube[4], cube[5], cube[6]});
            add_wedge({cube[0], cube[2], cube[3], cube[4], cube[6], cube[7]});
          } else if (one_in(2)) {
            add_pyramids(cube);
          } else {
            add(CellShape::hexahedron, {cube.begin(), cube.end()});
          }
        }
      }
    }
    shuffle_points();
  }

  const UnstructuredGrid& grid() const noexcept { return grid_; }
  double volume() const noexcept { return static_cast<double>(n_) * n_ * n_ * side * side * side; }

 private:
  bool one_in(unsigned k) { return random_() % k == 0; }
  double moved(int i) {
    const bool inside = i > 0 && i < n_;
    return i * side + (inside ? 8 * (static_cast<int>(random_() % 21) - 10) : 0);
  }
  std::array<std::int32_t, 8> corners(int i, int j, int k) const {
    const auto at = [&](int x, int y, int z) { return x + (n_ + 1) * (y + (n_ + 1) * z); };
    return {at(i, j, k),     at(i + 1, j, k),     at(i + 1, j + 1, k),     at(i, j + 1, k),
            at(i, j, k + 1), at(i + 1, j, k + 1), at(i + 1, j + 1, k + 1), at(i, j + 1, k + 1)};
  }
  void add(CellShape shape, const std::vector<std::int32_t>& points) {
    grid_.shapes.push_back(shape);
    grid_.corners.insert(grid_.corners.end(), points.begin(), points.end());
  }
  /// The cell, or a hexahedron that collapses to it.
  void add(CellShape shape, const std::vector<std::int32_t>& points,
           const std::vector<std::int32_t>& hexahedron) {
    if (collapsed_ && one_in(3)) return add(CellShape::hexahedron, hexahedron);
    add(shape, points);
  }
  std::int32_t add_middle(const std::vector<std::int32_t>& points) {
    Vec3<double> sum;
    for (const std::int32_t p : points) sum = sum + grid_.points[static_cast<std::size_t>(p)];
    for (int a = 0; a < 3; ++a) {
      sum[a] = 8 * std::round(sum[a] / (8 * static_cast<double>(points.size())));
    }
    grid_.points.push_back(sum);
    return static_cast<std::int32_t>(grid_.points.size()) - 1;
  }
  void add_pyramid(std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d,
                   std::int32_t apex) {
    add(CellShape::pyramid, {a, b, c, d, apex}, {a, b, c, d, apex, apex, apex, apex});
  }
  /// One, or what is around a point in its middle.
  void add_wedge(const std::array<std::int32_t, 6>& w) {
    if (!one_in(3)) {
      return add(CellShape::wedge, {w.begin(), w.end()},
                 {w[0], w[1], w[2], w[2], w[3], w[4], w[5], w[5]});
    }
    const std::int32_t m = add_middle({w.begin(), w.end()});
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      add_pyramid(w[i], w[j], w[3 + j], w[3 + i], m);
    }
    for (const std::size_t i : {0U, 3U}) {
      add(CellShape::tetrahedron, {w[i], w[i + 1], w[i + 2], m},
          {w[i], w[i + 1], w[i + 2], w[i + 2], m, m, m, m});
    }
  }
  /// Around a point in the middle.
  void add_pyramids(const std::array<std::int32_t, 8>& c) {
    const std::int32_t m = add_middle({c.begin(), c.end()});
    add_pyramid(c[0], c[1], c[2], c[3], m);
    add_pyramid(c[4], c[5], c[6], c[7], m);
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t j = (i + 1) % 4;
      add_pyramid(c[i], c[j], c[4 + j], c[4 + i], m);
    }
  }
  void shuffle_points() {
    std::vector<std::int32_t> number(grid_.points.size());
    std::iota(number.begin(), number.end(), 0);
    std::ranges::shuffle(number, random_);
    std::vector<Vec3<double>> points(number.size());
    for (std::size_t i = 0; i < number.size(); ++i) {
      points[static_cast<std::size_t>(number[i])] = grid_.points[i];
    }
    grid_.points = std::move(points);
    for (std::int32_t& c : grid_.corners) c = number[static_cast<std::size_t>(c)];
  }

  int n_;
  bool collapsed_;
  std::mt19937 random_;
  UnstructuredGrid grid_;
};

}  // namespace pellucid
