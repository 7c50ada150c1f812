// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "field.h"
#include "mesh.h"
#include "pellucid/scene/mesh_channels.h"

namespace pellucid::reference {

/// The channels of a mesh: linear between the points of a tetrahedron, or constant in it. A view of
/// them.
class MeshField : public Field {
 public:
  explicit MeshField(const MeshChannels& channels);

  Real visit(const RealRay& ray, const Visit& visit) const override;

 private:
  /// A chord for each channel; none where a value is NaN in any of them.
  std::vector<Chord> chords(const TetrahedronCrossing& crossing) const;

  const MeshChannels& channels_;
  Mesh mesh_;
};

}  // namespace pellucid::reference
