// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "linear_cells.h"
#include "pellucid/geometry/vec3.h"

// Quadratic cells cut at their nodes into linear ones, which are cut in turn. Every edge of a cell
// becomes two, every triangle four, every quadrilateral four around its middle: the same from both
// sides of a face. Nodes stand in VTK's order, those in the middle of quadrilaterals and of
// hexahedra included (added_points.h).

namespace pellucid {

/// Cuts an octahedron, of whose six points 0 and 3, 1 and 4, 2 and 5 are opposite to each other:
/// four tetrahedra around its shortest diagonal, the one that is most likely inside where edges are
/// curved.
template <class Emit>
void tetrahedralize_octahedron(const std::int32_t* v, const Vec3<double>* points,
                               const Emit& emit) {
  // Opposite corners, and the four others in a circle.
  constexpr int diagonal[3][6] = {{0, 3, 5, 4, 2, 1}, {5, 2, 0, 4, 3, 1}, {1, 4, 0, 5, 3, 2}};
  const int* shortest = nullptr;
  double least = 0;
  for (const int* d : diagonal) {
    const Vec3<double> along = points[v[d[1]]] - points[v[d[0]]];
    const double squared = dot(along, along);
    if (shortest == nullptr || squared < least) {
      shortest = d;
      least = squared;
    }
  }
  for (int i = 0; i < 4; ++i) {
    emit(v[shortest[0]], v[shortest[1]], v[shortest[2 + i]], v[shortest[2 + (i + 1) % 4]]);
  }
}

/// Cuts a tetrahedron of 10 nodes: one at each corner, and the octahedron of the edges' nodes.
template <class Emit>
void tetrahedralize_quadratic_tetrahedron(const std::int32_t* v, const Vec3<double>* points,
                                          const Emit& emit) {
  emit(v[0], v[4], v[6], v[7]);
  emit(v[4], v[1], v[5], v[8]);
  emit(v[6], v[5], v[2], v[9]);
  emit(v[7], v[8], v[9], v[3]);
  const std::int32_t octahedron[6] = {v[4], v[6], v[7], v[9], v[8], v[5]};
  tetrahedralize_octahedron(octahedron, points, emit);
}

/// Cuts a pyramid of 14 nodes: one at each corner, one upside down between them, and a tetrahedron
/// below each side.
template <class Emit>
void tetrahedralize_quadratic_pyramid(const std::int32_t* v, const Emit& emit) {
  const std::int32_t apex = v[4], middle = v[13];
  const std::int32_t *base = v, *edge = v + 5, *rising = v + 9;
  for (int i = 0; i < 4; ++i) {
    const int before = (i + 3) % 4, after = (i + 1) % 4;
    const std::int32_t corner[5] = {base[i], edge[i], middle, edge[before], rising[i]};
    tetrahedralize_pyramid(corner, emit);
    emit(edge[i], rising[i], rising[after], middle);
  }
  const std::int32_t top[5] = {rising[0], rising[1], rising[2], rising[3], apex};
  const std::int32_t inverted[5] = {rising[0], rising[1], rising[2], rising[3], middle};
  tetrahedralize_pyramid(top, emit);
  tetrahedralize_pyramid(inverted, emit);
}

/// Cuts a wedge of 18 nodes: two layers of four.
template <class Emit>
void tetrahedralize_quadratic_wedge(const std::int32_t* v, const Emit& emit) {
  // Each layer of nodes: the corners of a triangle, then the middles of its edges.
  constexpr int layer[3][6] = {{0, 1, 2, 6, 7, 8}, {12, 13, 14, 15, 16, 17}, {3, 4, 5, 9, 10, 11}};
  constexpr int triangle[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
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

/// Cuts a hexahedron of 27 nodes: into eight.
template <class Emit>
void tetrahedralize_quadratic_hexahedron(const std::int32_t* v, const Emit& emit) {
  // The nodes as a grid, x fastest.
  constexpr int node[27] = {0,  8,  1,  11, 24, 9,  3, 10, 2,  16, 22, 17, 20, 26,
                            21, 19, 23, 18, 4,  12, 5, 15, 25, 13, 7,  14, 6};
  for (int part = 0; part < 8; ++part) {
    std::int32_t voxel[8];
    for (int corner = 0; corner < 8; ++corner) {
      const int x = (part & 1) + (corner & 1), y = (part >> 1 & 1) + (corner >> 1 & 1),
                z = (part >> 2) + (corner >> 2);
      voxel[corner] = v[node[x + 3 * y + 9 * z]];
    }
    tetrahedralize_voxel(voxel, emit);
  }
}

}  // namespace pellucid
