// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/field/trilinear.h"
#include "pellucid/scene/light.h"
#include "pellucid/scene/volume.h"
#include "pellucid/traverse/structured_walk.h"

namespace pellucid {

/// The gradient of a volume in the world (GradientKind), from the data in their own type; nothing
/// is kept but weights along the axes.
class GridGradient {
 public:
  GridGradient(const Volume& volume, GradientKind kind);

  /// Computes the three components along a step through a cell, which has no NaN corner.
  void along(const StructuredWalk<double>::Step& step, CubicBernstein<double> (&gradient)[3]) const;
  /// Computes the magnitude of the `smooth` gradient at the data values, trilinear between.
  CubicBernstein<double> magnitude_along(const StructuredWalk<double>::Step& step) const;

 private:
  /// Gradients at the corners of a cell, in the world.
  struct Corners {
    Vec3<double> at[8];
  };
  Corners smooth_corners(const int (&cell)[3]) const;
  Corners field_corners(const int (&cell)[3]) const;
  Vec3<double> to_world(const Vec3<double>& gradient_grid) const;

  /// Distances from a data value to its neighbors; 0 where there is none.
  struct Neighbors {
    double before, behind;
  };
  /// The derivative along an axis at a value with what is before and behind it, which may be NaN.
  static double derivative(const Neighbors& apart, double before, double value, double behind);

  const Volume& volume_;
  GradientKind kind_;
  std::vector<Neighbors> neighbors_[3];
};

}  // namespace pellucid
