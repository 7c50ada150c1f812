// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "chord.h"
#include "pellucid/scene/volume.h"

namespace pellucid::reference {

/// A stretch of a ray inside one cell.
struct Crossing {
  Real t_begin, t_end;  ///< world arc length
  std::array<int, 3> cell;
  Real3 entry, exit;  ///< in the cell's own coordinates, [0, 1]³
};

/// Where the planes of a volume's grid stand, and what a ray meets there.
class Grid {
 public:
  explicit Grid(const Volume& volume);
  /// The cells around the values, one for each, bounded half-way to the next one and by the
  /// volume's box: those of labels.
  static Grid around_values(const Volume& volume);

  /// Every cell that the ray (direction of length 1) crosses at t >= 0, front to back: the
  /// parameters of all planes of all axes, sorted.
  std::vector<Crossing> crossings(const RealRay& ray_world) const;

  /// The data along a crossing; nothing where a corner of the cell is NaN.
  std::optional<Chord> chord(const Crossing& crossing) const;
  /// The data value at a crossing's lower corner: of cells around values the value of the cell.
  Real value(const Crossing& crossing) const;

 private:
  RealRay to_grid(const RealRay& ray_world) const;

  const Volume& volume_;
  std::array<Real3, 3> inverse_;  ///< rows of the inverse of direction · spacing
  Real3 origin_;
  std::array<std::vector<Real>, 3> planes_;        ///< ascending, in grid coordinates
  std::array<std::vector<std::size_t>, 3> shown_;  ///< index of the data value at each plane
};

}  // namespace pellucid::reference
