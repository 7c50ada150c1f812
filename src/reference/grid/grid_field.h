// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "derived_channels.h"
#include "field.h"
#include "grid.h"

namespace pellucid::reference {

/// Volumes on one grid, that of the first. A view of them.
class GridField : public Field {
 public:
  explicit GridField(const std::vector<const Volume*>& volumes,
                     const DerivedChannels& derived = {});

  Real visit(const RealRay& ray, const Visit& visit) const override;

 private:
  /// Returns a chord for each volume, then those derived; none where a corner is NaN in any volume.
  std::vector<Chord> chords(const Crossing& crossing) const;

  std::vector<Grid> grids_;
  DerivedChannels derived_;
};

}  // namespace pellucid::reference
