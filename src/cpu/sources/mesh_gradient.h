// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pellucid/field/tetrahedra.h"
#include "pellucid/geometry/ray.h"
#include "pellucid/math/bernstein.h"
#include "pellucid/render/integrate_cell.h"
#include "pellucid/scene/light.h"

namespace pellucid {

/// The gradient of a variable of a mesh (GradientKind): constant in each tetrahedron, or linear
/// between those of the points, which are kept.
class MeshGradient {
 public:
  /// Finds the gradients. Mesh and field must outlive the object. `points`: how many the mesh has.
  MeshGradient(const Tetrahedra& mesh, const MeshField& field, std::size_t points,
               GradientKind kind);

  /// Computes the three components on a range of a ray inside a tetrahedron.
  void along(std::int32_t tetrahedron, const Ray<double>& ray, Interval<double> range,
             CubicBernstein<double> (&gradient)[3]) const;
  /// Computes the magnitude at the points, linear between.
  CubicBernstein<double> magnitude_along(std::int32_t tetrahedron, const Ray<double>& ray,
                                         Interval<double> range) const;

 private:
  /// Returns the constant gradient in a tetrahedron, 0 where there is none; and its volume.
  Vec3<double> constant(std::int32_t tetrahedron, double& volume) const;
  /// Returns a linear function of the four corners' numbers along the ray.
  CubicBernstein<double> linear(std::int32_t tetrahedron, const double (&corner)[4],
                                const Ray<double>& ray, Interval<double> range) const;

  const Tetrahedra mesh_;
  const MeshField field_;
  GradientKind kind_;
  std::vector<Vec3<double>> of_point_;
};

}  // namespace pellucid
