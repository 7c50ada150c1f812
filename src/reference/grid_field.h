// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "field.h"
#include "grid.h"

namespace pellucid::reference {

/// Volumes on one grid, that of the first. A view of them.
class GridField : public Field {
 public:
  explicit GridField(const std::vector<const Volume*>& volumes);

  Real visit(const RealRay& ray, const Visit& visit) const override;

 private:
  /// A chord for each volume; none where a corner is NaN in any of them.
  std::vector<Chord> chords(const Crossing& crossing) const;

  std::vector<Grid> grids_;
};

}  // namespace pellucid::reference
