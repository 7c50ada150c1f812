// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

// Linear cells cut into tetrahedra. All by one rule: a quadrilateral is cut by the diagonal at its
// point of the smallest index, and a cell is the cone from its own such point to the faces that
// lack it. The faces that have it are then cut by diagonals through it, as the rule wants, and any
// choice of the others is feasible.
//
// Where an index stands twice (a collapsed edge) the same holds of what is left when tetrahedra
// with two equal points are dropped: a quadrilateral with two equal neighbours is a triangle
// however it is cut, and one with two equal opposite points is cut by them or beside them in every
// cell alike.

namespace pellucid {

/// Returns whether a quadrilateral's diagonal runs from its first to its third point.
inline bool diagonal_is_at_first(std::int32_t a, std::int32_t b, std::int32_t c,
                                 std::int32_t d) noexcept {
  return std::min(a, c) < std::min(b, d);
}

template <class Emit>
void tetrahedralize_cone(std::int32_t apex, std::int32_t a, std::int32_t b, std::int32_t c,
                         std::int32_t d, const Emit& emit) {
  if (diagonal_is_at_first(a, b, c, d)) {
    emit(apex, a, b, c);
    emit(apex, a, c, d);
  } else {
    emit(apex, a, b, d);
    emit(apex, b, c, d);
  }
}

/// Cuts a pyramid. Its base is points 0 to 3, in a circle.
template <class Emit>
void tetrahedralize_pyramid(const std::int32_t* v, const Emit& emit) {
  tetrahedralize_cone(v[4], v[0], v[1], v[2], v[3], emit);
}

/// Cuts a wedge. Its triangles are points 0 to 2 and, in the same order, 3 to 5.
template <class Emit>
void tetrahedralize_wedge(const std::int32_t* v, const Emit& emit) {
  const auto first = static_cast<int>(std::min_element(v, v + 6) - v);
  const int own = first < 3 ? 0 : 3, other = 3 - own;
  const int i = (first + 1) % 3, j = (first + 2) % 3;
  emit(v[first], v[other], v[other + 1], v[other + 2]);
  tetrahedralize_cone(v[first], v[own + i], v[own + j], v[other + j], v[other + i], emit);
}

/// Cuts a voxel, whose points are numbered x fastest.
template <class Emit>
void tetrahedralize_voxel(const std::int32_t* v, const Emit& emit) {
  const auto first = static_cast<unsigned>(std::min_element(v, v + 8) - v);
  const std::int32_t p = v[first], q = v[first ^ 7U];
  // Along axis i from the smallest point and from the one that lies opposite to it.
  const std::int32_t near[3] = {v[first ^ 1U], v[first ^ 2U], v[first ^ 4U]};
  const std::int32_t far[3] = {v[first ^ 6U], v[first ^ 5U], v[first ^ 3U]};

  const bool through[3] = {diagonal_is_at_first(q, far[1], near[0], far[2]),
                           diagonal_is_at_first(q, far[2], near[1], far[0]),
                           diagonal_is_at_first(q, far[0], near[2], far[1])};
  if (!through[0] && !through[1] && !through[2]) {
    // The three tetrahedra around the diagonal from p to q are also these two.
    emit(p, far[0], far[1], far[2]);
    emit(q, far[0], far[1], far[2]);
    for (unsigned i = 0; i < 3; ++i) emit(p, far[(i + 1) % 3], near[i], far[(i + 2) % 3]);
    return;
  }
  for (unsigned i = 0; i < 3; ++i) {
    const std::int32_t a = far[(i + 1) % 3], b = far[(i + 2) % 3];
    if (through[i]) {
      emit(p, q, a, near[i]);
      emit(p, q, near[i], b);
    } else {
      emit(p, a, near[i], b);
      emit(p, q, a, b);
    }
  }
}

/// Cuts a hexahedron. Its bottom is points 0 to 3, in a circle; the top, in the same order, 4 to 7.
template <class Emit>
void tetrahedralize_hexahedron(const std::int32_t* v, const Emit& emit) {
  const std::int32_t voxel[8] = {v[0], v[1], v[3], v[2], v[4], v[5], v[7], v[6]};
  tetrahedralize_voxel(voxel, emit);
}

}  // namespace pellucid
