// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <random>
#include <vector>

#include "pellucid/scene/unstructured_grid.h"

namespace pellucid {

/// A mesh of linear cells with nodes in the middle of its edges, moved by at most `bend` along each
/// axis where edges are inside of the box from 0 to `size`. Where `middles` says so at random,
/// wedges and hexahedra get the nodes in their middles too.
///
/// Coordinates that are multiples of 8 stay multiples of 4.
class QuadraticMesh {
 public:
  QuadraticMesh(const UnstructuredGrid& linear, double size, int bend, bool middles, unsigned seed)
      : size_(size), bend_(bend), random_(seed) {
    grid_.points = linear.points;
    const std::int32_t* cell = linear.corners.data();
    for (const CellShape shape : linear.shapes) {
      const bool completed = middles && random_() % 2 == 0;
      std::vector<std::int32_t> nodes(cell, cell + point_count(shape));
      for (const auto& edge : edges_of(shape)) add_middle(nodes, cell, edge);
      const bool is_wedge = shape == CellShape::wedge;
      if (completed && (is_wedge || shape == CellShape::hexahedron)) {
        for (const auto& face : is_wedge ? wedge_faces : hexahedron_faces) {
          add_middle(nodes, cell, face);
        }
        if (!is_wedge) add_middle(nodes, cell, {0, 1, 2, 3, 4, 5, 6, 7});
        grid_.shapes.push_back(is_wedge ? CellShape::biquadratic_wedge
                                        : CellShape::triquadratic_hexahedron);
      } else {
        grid_.shapes.push_back(quadratic(shape));
      }
      grid_.corners.insert(grid_.corners.end(), nodes.begin(), nodes.end());
      cell += point_count(shape);
    }
  }

  const UnstructuredGrid& grid() const noexcept { return grid_; }

 private:
  using Nodes = std::vector<std::vector<std::size_t>>;
  inline static const Nodes wedge_faces{{0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}};
  inline static const Nodes hexahedron_faces{{0, 3, 7, 4}, {1, 2, 6, 5}, {0, 1, 5, 4},
                                             {3, 2, 6, 7}, {0, 1, 2, 3}, {4, 5, 6, 7}};

  static CellShape quadratic(CellShape shape) {
    switch (shape) {
      case CellShape::tetrahedron:
        return CellShape::quadratic_tetrahedron;
      case CellShape::pyramid:
        return CellShape::quadratic_pyramid;
      case CellShape::wedge:
        return CellShape::quadratic_wedge;
      default:
        return CellShape::quadratic_hexahedron;
    }
  }
  /// In VTK's order.
  static Nodes edges_of(CellShape shape) {
    switch (shape) {
      case CellShape::tetrahedron:
        return {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
      case CellShape::pyramid:
        return {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}};
      case CellShape::wedge:
        return {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}};
      default:
        return {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
    }
  }

  /// Appends the node in the middle of some points of a cell; the same one for the same points.
  void add_middle(std::vector<std::int32_t>& nodes, const std::int32_t* cell,
                  const std::vector<std::size_t>& of) {
    std::vector<std::int32_t> points;
    points.reserve(of.size());
    for (const std::size_t i : of) points.push_back(cell[i]);
    std::ranges::sort(points);
    const auto [at, is_new] =
        middle_.try_emplace(points, static_cast<std::int32_t>(grid_.points.size()));
    if (is_new) {
      Vec3<double> sum;
      for (const std::int32_t p : points) sum = sum + grid_.points[static_cast<std::size_t>(p)];
      Vec3<double> middle;
      for (int a = 0; a < 3; ++a) {
        middle[a] = 4 * static_cast<int>(sum[a] / (4 * static_cast<double>(points.size())));
        if (middle[a] > 0 && middle[a] < size_) middle[a] += bent();
      }
      grid_.points.push_back(middle);
    }
    nodes.push_back(at->second);
  }
  int bent() {
    const int steps = bend_ / 4;
    return 4 * (static_cast<int>(random_() % static_cast<unsigned>(2 * steps + 1)) - steps);
  }

  double size_;
  int bend_;
  std::mt19937 random_;
  UnstructuredGrid grid_;
  std::map<std::vector<std::int32_t>, std::int32_t> middle_;
};

}  // namespace pellucid
