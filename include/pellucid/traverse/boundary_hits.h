// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/traverse/mesh_face.h"

namespace pellucid {

/// Crossing of a line and the boundary of a mesh.
struct MeshHit {
  double t = 0;
  std::int32_t code = Tetrahedron::outside;  ///< 4 · tetrahedron + face

  PELLUCID_HD friend constexpr bool operator<(const MeshHit& a, const MeshHit& b) noexcept {
    return a.t < b.t || (a.t == b.t && a.code < b.code);
  }
};

/// Returns the parameter at which the ray crosses a face, by the weights of its points.
PELLUCID_HD inline double parameter_of(const SeenFace<double>& face) noexcept {
  double weight[3];
  face.weights(weight);
  return face.seen[0].t + (weight[1] * (face.seen[1].t - face.seen[0].t) +
                           weight[2] * (face.seen[2].t - face.seen[0].t));
}

/// The tree's boxes as a line sees them.
class LineInBoxes {
 public:
  PELLUCID_HD explicit LineInBoxes(const Ray<double>& ray) noexcept : ray_(ray) {
    for (int a = 0; a < 3; ++a) inverse_[a] = 1 / ray.direction[a];
  }
  /// Returns whether the line, in both directions, may meet the box. Boxes are larger than what is
  /// in them by more than this rounds.
  PELLUCID_HD bool meets(const BoundaryNode& box) const noexcept {
    double begin = -std::numeric_limits<double>::infinity(), end = -begin;
    for (int a = 0; a < 3; ++a) {
      const double lower = static_cast<double>(box.lower[a]),
                   upper = static_cast<double>(box.upper[a]);
      if (ray_.direction[a] == 0) {
        if (ray_.origin[a] < lower || ray_.origin[a] > upper) return false;
        continue;
      }
      const double p = (lower - ray_.origin[a]) * inverse_[a],
                   q = (upper - ray_.origin[a]) * inverse_[a];
      begin = max(begin, min(p, q));
      end = min(end, max(p, q));
    }
    return begin <= end;
  }

 private:
  Ray<double> ray_;
  Vec3<double> inverse_;
};

/// Calls visit(MeshHit) for every boundary face that the line goes through, in the tree's order.
template <class Visit>
PELLUCID_HD void for_each_boundary_hit(const Tetrahedra& mesh, const Ray<double>& ray,
                                       const RayFrame<double>& view, Visit&& visit) noexcept {
  const LineInBoxes boxes({view.origin, ray.direction});
  // Halves of a list of less than 2^31 faces.
  std::int32_t stack[64];
  int open = 0;
  stack[open++] = 0;
  while (open > 0) {
    const BoundaryNode& node = mesh.tree[stack[--open]];
    if (!boxes.meets(node)) continue;
    if (node.count == 0) {
      stack[open++] = node.first;
      stack[open++] = node.first + 1;
      continue;
    }
    for (std::int32_t i = 0; i < node.count; ++i) {
      const std::int32_t code = mesh.boundary[node.first + i];
      SeenFace<double> face;
      if (see_face(mesh, view, code, face)) visit(MeshHit{parameter_of(face), code});
    }
  }
}

}  // namespace pellucid
