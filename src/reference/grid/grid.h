// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "chord.h"
#include "pellucid/scene/light.h"
#include "pellucid/scene/volume.h"

namespace pellucid::reference {

/// A stretch of a ray inside one cell.
struct Crossing {
  Real t_begin, t_end;  ///< world arc length
  std::array<int, 3> cell;
  Real3 entry, exit;  ///< in the cell's own coordinates, [0, 1]³
};

/// Planes of a volume's grid, and the cells that a ray crosses.
class Grid {
 public:
  explicit Grid(const Volume& volume);
  /// Returns the cells around the values, one for each, bounded half-way to the next one and by the
  /// volume's box: those of labels.
  static Grid around_values(const Volume& volume);

  /// Returns every cell that the ray (direction of length 1) crosses at t >= 0, front to back: the
  /// parameters of all planes of all axes, sorted.
  std::vector<Crossing> crossings(const RealRay& ray_world) const;

  /// Returns the data along a crossing; nothing where a corner of the cell is NaN.
  std::optional<Chord> chord(const Crossing& crossing) const;
  /// Returns the data value at a crossing's lower corner: of cells around values the value of the
  /// cell.
  Real value(const Crossing& crossing) const;

  /// Returns the gradient of the data along a crossing without NaN corners: x, y and z of the
  /// world.
  std::array<Chord, 3> gradient(const Crossing& crossing, GradientKind kind) const;
  /// Returns the magnitudes of the smooth gradient at the corners, interpolated like the data.
  Chord gradient_magnitude(const Crossing& crossing) const;

 private:
  using Index = std::array<std::size_t, 3>;

  RealRay to_grid(const RealRay& ray_world) const;
  /// Returns the data value that corner k of a crossing's cell shows.
  Index shown_at(const Crossing& crossing, std::size_t k) const;
  Real value_at(const Index& index) const;
  /// Returns world gradient at a data value; NaN neighbours are left out.
  Real3 smooth_gradient(const Index& index) const;
  /// Returns world gradient of the trilinear data at corner k.
  Real3 cell_gradient(const Crossing& crossing, std::size_t k) const;
  Real3 gradient_in_world(const Real3& in_grid) const;

  const Volume& volume_;
  std::array<Real3, 3> inverse_;  ///< rows of the inverse of direction · spacing
  Real3 origin_;
  std::array<std::vector<Real>, 3> planes_;        ///< ascending, in grid coordinates
  std::array<std::vector<std::size_t>, 3> shown_;  ///< index of the data value at each plane
  std::array<std::vector<Real>, 3> positions_;     ///< of the data values
};

}  // namespace pellucid::reference
