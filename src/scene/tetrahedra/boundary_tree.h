// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/field/tetrahedra.h"
#include "pellucid/geometry/box.h"

namespace pellucid {

/// The faces of a mesh behind which nothing is, and a tree of boxes over them, each node's children
/// together and its box around theirs, a little larger than they are: by 2^-21 of the largest
/// coordinate, against which the rounding of rays is small.
struct BoundaryTree {
  std::vector<BoundaryNode> node;
  std::vector<std::int32_t> face;  ///< 4 · tetrahedron + face, in the order of the leaves
};

BoundaryTree build_boundary_tree(const std::vector<Tetrahedron>& tetrahedra,
                                 const std::vector<Vec3<double>>& points,
                                 const Box<double>& bounds);

}  // namespace pellucid
