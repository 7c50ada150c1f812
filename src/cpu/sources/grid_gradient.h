// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "layers/plane_ambiguity.h"
#include "pellucid/field/grid_gradient.h"
#include "pellucid/field/sample.h"
#include "pellucid/scene/light.h"
#include "pellucid/scene/volume.h"
#include "pellucid/traverse/structured_walk.h"

namespace pellucid {

/// The gradient of a volume in the world (GradientKind), from the data in their own type; nothing
/// is kept but weights along the axes.
class GridGradient {
 public:
  GridGradient(const Volume& volume, GradientKind kind);

  GradientKind kind() const noexcept { return kind_; }

  /// Computes the three components along a step through a cell, which has no NaN corner.
  void along(const StructuredWalk<double>::Step& step, CubicBernstein<double> (&gradient)[3]) const;
  /// Returns by how much the coefficients of the gradient may differ, because the ray may be in a
  /// neighbor of the step's cell: where rays run along planes, at which gradients `field` jump. Of
  /// the others 0. `axis`: that of the walk; `gradient`: that of along().
  double doubt(const StructuredWalk<double>::Step& step, const GridAxis<double> (&axis)[3],
               const PlaneAmbiguity& planes, const CubicBernstein<double> (&gradient)[3]) const;
  /// Returns whether it may differ at all.
  bool is_doubtful(const StructuredWalk<double>::Step& step, const GridAxis<double> (&axis)[3],
                   const PlaneAmbiguity& planes) const;
  /// Computes the magnitude of the `smooth` gradient at the data values, trilinear between.
  CubicBernstein<double> magnitude_along(const StructuredWalk<double>::Step& step) const;
  /// Return both at a place; its cell has no NaN corner.
  Vec3<double> at(const GridPlace<double>& place) const;
  double magnitude_at(const GridPlace<double>& place) const;

 private:
  CornerGradients smooth_corners(const int (&cell)[3]) const;
  CornerGradients corners(const int (&cell)[3]) const;

  const Volume& volume_;
  GradientKind kind_;
  std::vector<NeighborDistances> neighbors_[3];
};

}  // namespace pellucid
