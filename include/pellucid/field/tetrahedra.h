// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "pellucid/geometry/vec3.h"

namespace pellucid {

/// A node of the tree over a mesh's boundary: a box and what is in it.
struct BoundaryNode {
  float lower[3], upper[3];  ///< rounded outwards
  /// Inner nodes (count 0): the first of two children, which stand together. Leaves: the first of
  /// `count` entries of the list of boundary faces.
  std::int32_t first = 0, count = 0;
};

/// Tetrahedra as rays walk through them. A view: it owns nothing, so that a device can hold it too.
///
/// The points of a tetrahedron stand in ascending order of their indices; face i is the one that
/// lies opposite to its i-th point. What lies behind face i is 4 · (the tetrahedron there) + (the
/// number that the face has in it), or outside.
struct Tetrahedra {
  static constexpr std::int32_t outside = -1;

  const Vec3<double>* point = nullptr;  ///< world
  const std::int32_t (*corner)[4] = nullptr;
  const std::int32_t (*behind)[4] = nullptr;
  std::int32_t count = 0;

  // The boundary: faces as 4 · tetrahedron + face, in the order of the tree; node 0 is the root.
  const BoundaryNode* tree = nullptr;
  const std::int32_t* boundary = nullptr;
  std::int32_t boundary_faces = 0;
};

}  // namespace pellucid
