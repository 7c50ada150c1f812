// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "grid/derived_channels.h"
#include "grid/field.h"
#include "mesh.h"
#include "mesh_gradient.h"
#include "pellucid/scene/mesh_channels.h"

namespace pellucid::reference {

/// The channels of a mesh: linear between the points of a tetrahedron, or constant in it. A view of
/// them.
class MeshField : public Field {
 public:
  explicit MeshField(const MeshChannels& channels, const DerivedChannels& derived = {});

  Real visit(const RealRay& ray, const Visit& visit) const override;

 private:
  /// Returns a chord for each channel, then those derived; none where a value is NaN in any
  /// channel.
  std::vector<Chord> chords(const TetrahedronCrossing& crossing) const;

  const MeshChannels& channels_;
  Mesh mesh_;
  DerivedChannels derived_;
  std::optional<MeshGradient> gradient_, for_magnitude_;
};

}  // namespace pellucid::reference
