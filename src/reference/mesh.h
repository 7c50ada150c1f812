// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "mesh_tree.h"

namespace pellucid::reference {

/// A stretch of a ray inside one tetrahedron.
struct TetrahedronCrossing {
  Real t_begin, t_end;  ///< world arc length
  std::size_t tetrahedron;
  std::array<Real, 4> entry, exit;  ///< weights of the tetrahedron's points
};

/// Tetrahedra on their own, and what a ray meets of them. A view of points and tetrahedra, which
/// may be given in either orientation and may overlap.
class Mesh {
 public:
  using Tetrahedron = std::array<std::int32_t, 4>;

  Mesh(const std::vector<Vec3<double>>& points, const std::vector<Tetrahedron>& tetrahedra);

  /// Every tetrahedron that the ray (direction of length 1) crosses at t >= 0, by where it begins.
  /// A ray that meets points or edges, or runs within faces, is moved aside by less than any
  /// number (EdgeSides), so that it crosses one of the tetrahedra that touch there.
  std::vector<TetrahedronCrossing> crossings(const RealRay& ray) const;

 private:
  const std::vector<Vec3<double>>& points_;
  const std::vector<Tetrahedron>& tetrahedra_;
  MeshTree tree_;
};

/// Of crossings in order: the length of the ray that is in two tetrahedra at once, and that between
/// first and last that is in none.
Real overlap_of(const std::vector<TetrahedronCrossing>& crossings);
Real gap_of(const std::vector<TetrahedronCrossing>& crossings);

}  // namespace pellucid::reference
