// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "pellucid/base/limits.h"
#include "pellucid/geometry/vec3.h"

namespace pellucid {

/// A tetrahedron: its points in ascending order of their indices, and its neighbors. Face i is
/// opposite to point i.
struct Tetrahedron {
  static constexpr std::int32_t outside = -1;

  std::int32_t corner[4];
  /// Per face 4 · (tetrahedron on its other side) + (index of the face in that tetrahedron), or
  /// `outside`.
  std::int32_t neighbor[4]{outside, outside, outside, outside};

  PELLUCID_HD constexpr std::int32_t operator[](int i) const noexcept { return corner[i]; }
  const std::int32_t* begin() const noexcept { return corner; }
  const std::int32_t* end() const noexcept { return corner + 4; }
};

/// A node of the bounding volume hierarchy over a mesh's boundary faces.
struct BoundaryNode {
  float lower[3], upper[3];  ///< widened by more than any rounding error
  /// Inner nodes (count 0): the first of two children, which are adjacent. Leaves: the first of
  /// `count` entries of the list of boundary faces.
  std::int32_t first = 0, count = 0;
};

/// A mesh as rays walk through it. A view; owns nothing, so that a device can hold it too.
struct Tetrahedra {
  const Vec3<double>* point = nullptr;
  const Tetrahedron* tetrahedron = nullptr;
  // The boundary: faces as 4 · tetrahedron + face, in the order of the tree; node 0 is the root.
  const BoundaryNode* tree = nullptr;
  const std::int32_t* boundary = nullptr;
  /// Box around all points; `coordinate_bound` is an upper bound on |coordinate|.
  Vec3<double> lower, upper;
  double coordinate_bound = 0;
  std::int32_t count = 0;  ///< number of tetrahedra

  /// Returns the center of the box.
  PELLUCID_HD Vec3<double> center() const noexcept { return 0.5 * (lower + upper); }
};

/// A point and the value of a variable there: four numbers, loaded together.
struct MeshPoint {
  Vec3<double> position;  ///< world
  double value = 0;       ///< 0 for a variable with one value per tetrahedron
};

/// A variable of a mesh in double: one value per point, linear in each tetrahedron, or one per
/// tetrahedron. NaN is vacuum.
struct MeshField {
  const double* value = nullptr;
  bool per_cell = false;
};

/// Several variables of a mesh.
struct MeshFields {
  MeshField channel[max_channels];
  int channels = 0;
};

}  // namespace pellucid
