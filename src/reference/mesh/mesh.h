// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "mesh_tree.h"
#include "pellucid/scene/tetrahedral_mesh.h"

namespace pellucid::reference {

/// A stretch of a ray inside one tetrahedron.
struct TetrahedronCrossing {
  Real t_begin, t_end;  ///< world arc length
  std::size_t tetrahedron;
  std::array<Real, 4> entry, exit;  ///< weights of the tetrahedron's points
};

/// Tetrahedra, each on its own, and what a ray meets of them: who lies beside whom is not looked
/// at. A view of a mesh.
class Mesh {
 public:
  explicit Mesh(const TetrahedralMesh& mesh);

  /// Returns every tetrahedron that the ray (direction of length 1) crosses at t >= 0, by where it
  /// begins. A ray that meets points or edges, or runs within faces, is moved aside by less than
  /// any number (EdgeSides), so that it crosses one of the tetrahedra that touch there.
  std::vector<TetrahedronCrossing> crossings(const RealRay& ray) const;

 private:
  const TetrahedralMesh& mesh_;
  MeshTree tree_;
};

/// Return of crossings in order the length of the ray that is in two tetrahedra at once, and that
/// between first and last that is in none.
Real overlap_of(const std::vector<TetrahedronCrossing>& crossings);
Real gap_of(const std::vector<TetrahedronCrossing>& crossings);

}  // namespace pellucid::reference
