// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "linear_cells.h"
#include "pellucid/geometry/vec3.h"
#include "pellucid/scene/unstructured_grid.h"
#include "quadratic_cells.h"

// Lagrange cells of any order, cut at their nodes into linear ones, which are cut in turn. Along
// each axis a cell of order k becomes k: every triangle k² triangles, every quadrilateral k times l
// quadrilaterals, the same from both sides of a face.

namespace pellucid {

/// Positions of the nodes of one kind of Lagrange cell in its list of points: VTK's order.
class LagrangeNodes {
 public:
  /// Finds the nodes. `layout`: as UnstructuredGrid::layouts, checked.
  LagrangeNodes(CellShape shape, const std::int32_t* layout);

  /// Returns the node at (i, j, k) of the lattice. Of a tetrahedron they are the weights of the
  /// corners 1, 2 and 3; of a wedge those of the corners 1 and 2, and the layer.
  int operator()(int i, int j, int k) const noexcept { return nodes_[index(i, j, k)]; }
  int order(int axis) const noexcept { return side_[axis] - 1; }
  /// Returns whether triangles and the cell have a node in their middle beside those of the
  /// lattice.
  bool has_middles() const noexcept { return has_middles_; }

 private:
  std::size_t index(int i, int j, int k) const noexcept {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(side_[0]) *
               (static_cast<std::size_t>(j) +
                static_cast<std::size_t>(side_[1]) * static_cast<std::size_t>(k));
  }

  int side_[3];
  bool has_middles_ = false;
  std::vector<int> nodes_;
};

/// The tables of all kinds that a grid has.
class LagrangeTables {
 public:
  LagrangeTables() = default;
  explicit LagrangeTables(const UnstructuredGrid& grid);
  /// Returns the nodes of a cell of the grid.
  const LagrangeNodes& of(const GridCell& cell) const { return tables_.find(key(cell))->second; }

 private:
  using Key = std::array<std::int32_t, 5>;
  static Key key(const GridCell& cell) noexcept {
    return {static_cast<std::int32_t>(cell.shape), cell.layout[0], cell.layout[1], cell.layout[2],
            cell.layout[3]};
  }
  std::map<Key, LagrangeNodes> tables_;
};

/// Makes a tetrahedron at every place of the lattice, octahedra between them, each cut into four
/// around its shortest diagonal, and tetrahedra upside down between those.
template <class Emit>
void tetrahedralize_lagrange_tetrahedron(const LagrangeNodes& nodes, const std::int32_t* v,
                                         const Vec3<double>* points, const Emit& emit) {
  const int order = nodes.order(0);
  for (int k = 0; k < order; ++k) {
    for (int j = 0; j + k < order; ++j) {
      for (int i = 0; i + j + k < order; ++i) {
        const auto at = [&](int x, int y, int z) { return v[nodes(i + x, j + y, k + z)]; };
        emit(at(0, 0, 0), at(1, 0, 0), at(0, 1, 0), at(0, 0, 1));
        const int room = order - (i + j + k);
        if (room >= 2) {
          const std::int32_t octahedron[6] = {at(1, 0, 0), at(0, 1, 0), at(0, 0, 1),
                                              at(0, 1, 1), at(1, 0, 1), at(1, 1, 0)};
          tetrahedralize_octahedron(octahedron, points, emit);
        }
        if (room >= 3) emit(at(1, 1, 1), at(0, 1, 1), at(1, 0, 1), at(1, 1, 0));
      }
    }
  }
}

/// Cuts a tetrahedron of 15 nodes: four in the middle of the triangles and one of the cell, behind
/// the 10 of a quadratic one. Around the last: a tetrahedron to each of the four triangles beside a
/// corner, and three to each of those in the middle of a side, which is cut at its node.
template <class Emit>
void tetrahedralize_tetrahedron_of_15(const std::int32_t* v, const Emit& emit) {
  constexpr int corner[4][4] = {{0, 4, 6, 7}, {1, 5, 4, 8}, {2, 6, 5, 9}, {3, 7, 8, 9}};
  // The nodes around those of the sides 0 2 1, 0 1 3, 1 2 3 and 0 3 2.
  constexpr int side[4][3] = {{6, 5, 4}, {4, 8, 7}, {5, 9, 8}, {7, 9, 6}};
  const std::int32_t middle = v[14];
  for (const auto& c : corner) {
    emit(v[c[0]], v[c[1]], v[c[2]], v[c[3]]);
    emit(middle, v[c[1]], v[c[2]], v[c[3]]);
  }
  for (int s = 0; s < 4; ++s) {
    for (int i = 0; i < 3; ++i) emit(middle, v[10 + s], v[side[s][i]], v[side[s][(i + 1) % 3]]);
  }
}

template <class Emit>
void tetrahedralize_lagrange_wedge(const LagrangeNodes& nodes, const std::int32_t* v,
                                   const Emit& emit) {
  const int order = nodes.order(0);
  const auto add_wedge = [&](int k, const std::array<std::array<int, 2>, 3>& triangle) {
    std::int32_t wedge[6];
    for (std::size_t c = 0; c < 3; ++c) {
      wedge[c] = v[nodes(triangle[c][0], triangle[c][1], k)];
      wedge[3 + c] = v[nodes(triangle[c][0], triangle[c][1], k + 1)];
    }
    tetrahedralize_wedge(wedge, emit);
  };
  for (int k = 0; k < nodes.order(2); ++k) {
    for (int j = 0; j < order; ++j) {
      for (int i = 0; i + j < order; ++i) {
        add_wedge(k, {{{i, j}, {i + 1, j}, {i, j + 1}}});
        if (i + j + 2 <= order) add_wedge(k, {{{i + 1, j}, {i + 1, j + 1}, {i, j + 1}}});
      }
    }
  }
}

/// Cuts a wedge of 21 nodes: in each of the three layers a triangle of seven, the last in its
/// middle.
template <class Emit>
void tetrahedralize_wedge_of_21(const std::int32_t* v, const Emit& emit) {
  constexpr int layer[3][7] = {
      {0, 1, 2, 6, 7, 8, 15}, {12, 13, 14, 17, 18, 19, 20}, {3, 4, 5, 9, 10, 11, 16}};
  constexpr int triangle[6][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 6}, {4, 5, 6}, {5, 3, 6}};
  for (int l = 0; l < 2; ++l) {
    for (const auto& t : triangle) {
      std::int32_t wedge[6];
      for (int i = 0; i < 3; ++i) {
        wedge[i] = v[layer[l][t[i]]];
        wedge[3 + i] = v[layer[l + 1][t[i]]];
      }
      tetrahedralize_wedge(wedge, emit);
    }
  }
}

template <class Emit>
void tetrahedralize_lagrange_hexahedron(const LagrangeNodes& nodes, const std::int32_t* v,
                                        const Emit& emit) {
  for (int k = 0; k < nodes.order(2); ++k) {
    for (int j = 0; j < nodes.order(1); ++j) {
      for (int i = 0; i < nodes.order(0); ++i) {
        std::int32_t voxel[8];
        for (int corner = 0; corner < 8; ++corner) {
          voxel[corner] = v[nodes(i + (corner & 1), j + (corner >> 1 & 1), k + (corner >> 2))];
        }
        tetrahedralize_voxel(voxel, emit);
      }
    }
  }
}

}  // namespace pellucid
