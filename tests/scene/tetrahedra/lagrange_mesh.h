// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <random>
#include <vector>

#include "pellucid/scene/unstructured_grid.h"

namespace pellucid {

/// The place of each node of a Lagrange cell in its lattice, in the order of nodes, as VTK 9.1 says
/// it: vtkHigherOrderTetra::BarycentricIndex, vtkHigherOrderWedge::PointIndexFromIJK and
/// vtkHigherOrderHexahedron::PointIndexFromIJK.
using Lattice = std::vector<std::array<int, 3>>;

/// Of order 4: the weights of the corners 1, 2 and 3.
inline Lattice tetrahedron_of_order_4() {
  return {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0},
          {3, 1, 0}, {2, 2, 0}, {1, 3, 0}, {0, 3, 0}, {0, 2, 0}, {0, 1, 0}, {0, 0, 1},
          {0, 0, 2}, {0, 0, 3}, {3, 0, 1}, {2, 0, 2}, {1, 0, 3}, {0, 3, 1}, {0, 2, 2},
          {0, 1, 3}, {1, 0, 1}, {2, 0, 1}, {1, 0, 2}, {1, 2, 1}, {1, 1, 2}, {2, 1, 1},
          {0, 1, 1}, {0, 1, 2}, {0, 2, 1}, {1, 1, 0}, {1, 2, 0}, {2, 1, 0}, {1, 1, 1}};
}

/// Of order 5, whose sides have nodes in triangles within triangles.
inline Lattice tetrahedron_of_order_5() {
  return {{0, 0, 0}, {5, 0, 0}, {0, 5, 0}, {0, 0, 5}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0},
          {4, 1, 0}, {3, 2, 0}, {2, 3, 0}, {1, 4, 0}, {0, 4, 0}, {0, 3, 0}, {0, 2, 0}, {0, 1, 0},
          {0, 0, 1}, {0, 0, 2}, {0, 0, 3}, {0, 0, 4}, {4, 0, 1}, {3, 0, 2}, {2, 0, 3}, {1, 0, 4},
          {0, 4, 1}, {0, 3, 2}, {0, 2, 3}, {0, 1, 4}, {1, 0, 1}, {3, 0, 1}, {1, 0, 3}, {2, 0, 1},
          {2, 0, 2}, {1, 0, 2}, {1, 3, 1}, {1, 1, 3}, {3, 1, 1}, {1, 2, 2}, {2, 1, 2}, {2, 2, 1},
          {0, 1, 1}, {0, 1, 3}, {0, 3, 1}, {0, 1, 2}, {0, 2, 2}, {0, 2, 1}, {1, 1, 0}, {1, 3, 0},
          {3, 1, 0}, {1, 2, 0}, {2, 2, 0}, {2, 1, 0}, {1, 1, 1}, {2, 1, 1}, {1, 2, 1}, {1, 1, 2}};
}

/// From the numbers of the nodes, layer by layer, row by row.
inline Lattice inverted(const std::vector<std::vector<std::vector<int>>>& numbers) {
  std::map<int, std::array<int, 3>> places;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    for (std::size_t j = 0; j < numbers[k].size(); ++j) {
      for (std::size_t i = 0; i < numbers[k][j].size(); ++i) {
        places[numbers[k][j][i]] = {static_cast<int>(i), static_cast<int>(j), static_cast<int>(k)};
      }
    }
  }
  Lattice lattice;
  for (const auto& [number, place] : places) lattice.push_back(place);
  return lattice;
}

/// Of order 4, and 3 along.
inline Lattice wedge_of_orders_4_and_3() {
  return inverted({{{0, 6, 7, 8, 1}, {14, 30, 31, 9}, {13, 32, 10}, {12, 11}, {2}},
                   {{24, 36, 37, 38, 26}, {50, 54, 55, 42}, {49, 56, 43}, {48, 44}, {28}},
                   {{25, 39, 40, 41, 27}, {53, 57, 58, 45}, {52, 59, 46}, {51, 47}, {29}},
                   {{3, 15, 16, 17, 4}, {23, 33, 34, 18}, {22, 35, 19}, {21, 20}, {5}}});
}

/// Of the orders 3, 2 and 4.
inline Lattice hexahedron_of_orders_3_2_and_4() {
  return inverted({{{0, 8, 9, 1}, {13, 50, 51, 10}, {3, 11, 12, 2}},
                   {{20, 38, 39, 23}, {32, 54, 55, 35}, {29, 44, 45, 26}},
                   {{21, 40, 41, 24}, {33, 56, 57, 36}, {30, 46, 47, 27}},
                   {{22, 42, 43, 25}, {34, 58, 59, 37}, {31, 48, 49, 28}},
                   {{4, 14, 15, 5}, {19, 52, 53, 16}, {7, 17, 18, 6}}});
}

/// A mesh of Lagrange cells in place of linear tetrahedra, wedges and hexahedra. Nodes at the same
/// place are one; those inside of the box from 0 to `size` are moved by at most `bend` along each
/// axis. Coordinates that are multiples of the order stay whole numbers.
class LagrangeMesh {
 public:
  /// `places`: the lattice of a shape, in the order of nodes.
  template <class Places>
  LagrangeMesh(const UnstructuredGrid& linear, const Places& places, double size, int bend,
               unsigned seed)
      : size_(size), bend_(bend), random_(seed) {
    for (CellWalk walk(linear); !walk.done();) {
      const GridCell cell = walk.next();
      const Lattice lattice = places(cell.shape);
      std::array<int, 3> order{};
      for (const auto& at : lattice) {
        for (std::size_t a = 0; a < 3; ++a) order[a] = std::max(order[a], at[a]);
      }
      for (const auto& at : lattice) {
        Vec3<double> t;
        for (int a = 0; a < 3; ++a) {
          const auto axis = static_cast<std::size_t>(a);
          t[a] = static_cast<double>(at[axis]) / order[axis];
        }
        grid_.corners.push_back(node(place(linear, cell, t)));
      }
      grid_.shapes.push_back(cell.shape == CellShape::tetrahedron ? CellShape::lagrange_tetrahedron
                             : cell.shape == CellShape::wedge     ? CellShape::lagrange_wedge
                                                                  : CellShape::lagrange_hexahedron);
      grid_.layouts.insert(grid_.layouts.end(), {static_cast<std::int32_t>(lattice.size()),
                                                 order[0], order[1], order[2]});
    }
  }

  const UnstructuredGrid& grid() const noexcept { return grid_; }

 private:
  static Vec3<double> place(const UnstructuredGrid& linear, const GridCell& cell,
                            const Vec3<double>& t) {
    const auto corner = [&](std::size_t i) {
      return linear.points[static_cast<std::size_t>(cell.points[i])];
    };
    const auto triangle = [&](std::size_t first) {
      return corner(first) + (corner(first + 1) - corner(first)) * t.x +
             (corner(first + 2) - corner(first)) * t.y;
    };
    if (cell.shape == CellShape::tetrahedron) {
      return triangle(0) + (corner(3) - corner(0)) * t.z;
    }
    if (cell.shape == CellShape::wedge) return triangle(0) * (1 - t.z) + triangle(3) * t.z;
    Vec3<double> sum;
    for (std::size_t i = 0; i < 8; ++i) {
      const double x = (i + 1) / 2 % 2 == 1 ? t.x : 1 - t.x, y = i / 2 % 2 == 1 ? t.y : 1 - t.y,
                   z = i >= 4 ? t.z : 1 - t.z;
      sum = sum + corner(i) * (x * y * z);
    }
    return sum;
  }

  std::int32_t node(const Vec3<double>& at) {
    const std::array<long, 3> key{std::lround(at.x), std::lround(at.y), std::lround(at.z)};
    const auto [found, is_new] =
        nodes_.try_emplace(key, static_cast<std::int32_t>(grid_.points.size()));
    if (is_new) {
      Vec3<double> moved;
      for (int a = 0; a < 3; ++a) {
        moved[a] = static_cast<double>(key[static_cast<std::size_t>(a)]);
        if (moved[a] <= 0 || moved[a] >= size_ || bend_ == 0) continue;
        moved[a] += static_cast<int>(random_() % static_cast<unsigned>(2 * bend_ + 1)) - bend_;
      }
      grid_.points.push_back(moved);
    }
    return found->second;
  }

  double size_;
  int bend_;
  std::mt19937 random_;
  UnstructuredGrid grid_;
  std::map<std::array<long, 3>, std::int32_t> nodes_;
};

}  // namespace pellucid
