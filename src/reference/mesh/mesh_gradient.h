// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/scene/light.h"
#include "pellucid/scene/mesh_channels.h"
#include "real.h"

namespace pellucid::reference {

/// The world gradient of one channel of a mesh; 0 for values per tetrahedron.
class MeshGradient {
 public:
  MeshGradient(const MeshChannels& channels, int channel, GradientKind kind);

  /// Returns the gradient at the points of a tetrahedron, linear between: of `field` four times the
  /// same.
  std::array<Real3, 4> at_points_of(std::size_t tetrahedron) const;

 private:
  const TetrahedralMesh& mesh_;
  GradientKind kind_;
  std::vector<Real3> gradients_;  ///< per point, or per tetrahedron for `field`
};

}  // namespace pellucid::reference
