// SPDX-License-Identifier: Apache-2.0
#include "lagrange_cells.h"

namespace pellucid {
namespace {

using Weights = std::array<int, 4>;

/// Returns the weights of the corners of a triangle's node, which add up to the order. Nodes stand
/// on triangles one inside of the other: the corners, then the edges, then those within.
std::array<int, 3> triangle_weights(int index, int order) {
  int least = 0, most = order;
  while (index != 0 && index >= 3 * order) {
    index -= 3 * order;
    most -= 2;
    ++least;
    order -= 3;
  }
  std::array<int, 3> weights{};
  const auto at = [&](int i) -> int& { return weights[static_cast<std::size_t>(i % 3)]; };
  if (index < 3) {
    at(index) = at(index + 1) = least;
    at(index + 2) = most;
  } else {
    const int edge = (index - 3) / (order - 1), step = (index - 3) % (order - 1);
    at(edge + 1) = least;
    at(edge + 2) = most - 1 - step;
    at(edge) = least + 1 + step;
  }
  return weights;
}

/// Returns the same of a tetrahedron: the weights of the corners 1, 2, 3 and 0.
Weights tetrahedron_weights(int index, int order) {
  // Where the weight of each corner stands, the corners of edges, and of sides the weights that
  // change in them, in the order of their own triangle, and the one that does not.
  constexpr int place[4] = {3, 0, 1, 2};
  constexpr int edges[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  constexpr std::size_t changing[4][3] = {{0, 2, 3}, {2, 0, 1}, {2, 1, 3}, {1, 0, 3}};
  int least = 0, most = order;
  while (index != 0 && order > 3 && index >= 2 * (order * order + 1)) {
    index -= 2 * (order * order + 1);
    most -= 3;
    ++least;
    order -= 4;
  }
  Weights weights;
  weights.fill(least);
  const auto of_corner = [&](int corner) -> int& {
    return weights[static_cast<std::size_t>(place[corner])];
  };
  const int on_edge = order - 1, on_side = (order - 1) * (order - 2) / 2;
  if (index < 4) {
    of_corner(index) = most;
  } else if (index - 4 < 6 * on_edge) {
    const int edge = (index - 4) / on_edge, step = (index - 4) % on_edge;
    of_corner(edges[edge][0]) = most - 1 - step;
    of_corner(edges[edge][1]) = least + 1 + step;
  } else {
    const int side = (index - 4 - 6 * on_edge) / on_side,
              node = (index - 4 - 6 * on_edge) % on_side;
    const std::array<int, 3> inner = triangle_weights(node, order - 3);
    for (std::size_t i = 0; i < 3; ++i) weights[changing[side][i]] = least + 1 + inner[i];
  }
  return weights;
}

int wedge_node(int i, int j, int k, int order, int along) {
  const int on_edge = order - 1, on_column = along - 1, on_triangle = (order - 1) * (order - 2) / 2;
  const bool last = i + j == order;
  const int corner = i == 0 && j == 0 ? 0 : i == order ? 1 : j == order ? 2 : -1;
  const bool cap = k == 0 || k == along;
  // Of triangles: rows of falling length.
  const auto within = [&] { return i - 1 + (j - 1) * (order - 1) - (j - 1) * j / 2; };
  if (corner >= 0 && cap) return corner + (k == 0 ? 0 : 3);
  const int edges = 6, columns = edges + 6 * on_edge, caps = columns + 3 * on_column,
            sides = caps + 2 * on_triangle, inside = sides + 3 * on_edge * on_column;
  if (corner >= 0) return columns + corner * on_column + k - 1;
  const int side = j == 0 ? 0 : last ? 1 : i == 0 ? 2 : -1;
  const int along_side = side == 0 ? i - 1 : side == 1 ? j - 1 : order - 1 - j;
  if (side >= 0 && cap) return edges + (k == 0 ? 0 : 3 * on_edge) + side * on_edge + along_side;
  if (cap) return caps + (k == 0 ? 0 : on_triangle) + within();
  if (side >= 0) return sides + on_edge * (side * on_column + k - 1) + along_side;
  return inside + on_triangle * (k - 1) + within();
}

int hexahedron_node(int i, int j, int k, const int* order) {
  const int n[3] = {order[0] - 1, order[1] - 1, order[2] - 1};  // inside of edges
  const bool x = i == 0 || i == order[0], y = j == 0 || j == order[1], z = k == 0 || k == order[2];
  const int corner = i != 0 ? (j != 0 ? 2 : 1) : (j != 0 ? 3 : 0);
  if (x && y && z) return corner + (k != 0 ? 4 : 0);
  const int edges = 8, ring = 2 * (n[0] + n[1]), columns = edges + 2 * ring,
            faces_x = columns + 4 * n[2], faces_y = faces_x + 2 * n[1] * n[2],
            faces_z = faces_y + 2 * n[0] * n[2], inside = faces_z + 2 * n[0] * n[1];
  if (y && z) return edges + (k != 0 ? ring : 0) + (j != 0 ? n[0] + n[1] : 0) + i - 1;
  if (x && z) return edges + (k != 0 ? ring : 0) + (i != 0 ? n[0] : 2 * n[0] + n[1]) + j - 1;
  if (x && y) return columns + n[2] * corner + k - 1;
  if (x) return faces_x + (i != 0 ? n[1] * n[2] : 0) + n[1] * (k - 1) + j - 1;
  if (y) return faces_y + (j != 0 ? n[0] * n[2] : 0) + n[0] * (k - 1) + i - 1;
  if (z) return faces_z + (k != 0 ? n[0] * n[1] : 0) + n[0] * (j - 1) + i - 1;
  return inside + n[0] * (n[1] * (k - 1) + j - 1) + i - 1;
}

}  // namespace

LagrangeNodes::LagrangeNodes(CellShape shape, const std::int32_t* layout)
    : side_{layout[1] + 1, layout[2] + 1, layout[3] + 1} {
  const int count = layout[0], order = layout[1];
  has_middles_ = count != lagrange_points(shape, {layout[1], layout[2], layout[3]});
  if (shape != CellShape::lagrange_hexahedron) side_[1] = side_[0];
  if (shape == CellShape::lagrange_tetrahedron) side_[2] = side_[0];
  if (has_middles_) return;
  nodes_.assign(static_cast<std::size_t>(side_[0]) * static_cast<std::size_t>(side_[1]) *
                    static_cast<std::size_t>(side_[2]),
                -1);
  const auto node = [&](int i, int j, int k) -> int& { return nodes_[index(i, j, k)]; };
  if (shape == CellShape::lagrange_tetrahedron) {
    for (int n = 0; n < count; ++n) {
      const Weights w = tetrahedron_weights(n, order);
      node(w[0], w[1], w[2]) = n;
    }
    return;
  }
  const bool is_wedge = shape == CellShape::lagrange_wedge;
  for (int k = 0; k < side_[2]; ++k) {
    for (int j = 0; j < side_[1]; ++j) {
      for (int i = 0; i < side_[0] - (is_wedge ? j : 0); ++i) {
        node(i, j, k) =
            is_wedge ? wedge_node(i, j, k, order, layout[3]) : hexahedron_node(i, j, k, layout + 1);
      }
    }
  }
}

LagrangeTables::LagrangeTables(const UnstructuredGrid& grid) {
  if (grid.layouts.empty()) return;
  for (CellWalk walk(grid); !walk.done();) {
    const GridCell cell = walk.next();
    if (cell.layout.empty() || cell.shape == CellShape::polyhedron) continue;
    const Key kind = key(cell);
    if (tables_.contains(kind)) continue;
    tables_.emplace(kind, LagrangeNodes(cell.shape, cell.layout.data()));
  }
}

}  // namespace pellucid
