// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "pellucid/scene/light.h"
#include "polynomial.h"

namespace pellucid::reference {

/// Color in light: factor ∘ color + added.
struct Reflection {
  Rgb<double> factor{1, 1, 1}, added{};
};

/// Position at which functions along a ray are nearly singular: they change within about `width` of
/// t. World arc length.
struct Bend {
  Real t, width;
};

/// Gradient components along a stretch of a ray, polynomials of u in [0, 1].
using GradientCubics = std::array<Polynomial, 3>;

/// The lights of a scene, as one ray (direction of length 1) sees them.
class RayLights {
 public:
  RayLights(const std::vector<Light>& lights, const RealRay& ray);

  /// Returns the reflection at the position t of the ray, with the normal there, of any length up
  /// to 1.
  Reflection reflection(const Shading& shading, const Real3& normal, Real t) const;

  /// Adds where the reflection has a kink on the stretch [t_begin, t_begin + length], as u: where
  /// a product |n·l| or |n·h| is 0, and where the ray passes a light. Some of these are none.
  void add_kinks(const Shading& shading, const GradientCubics& gradient, Real t_begin, Real length,
                 std::vector<Real>& kinks) const;
  /// Returns the positions at which the ray passes lights nearby.
  const std::vector<Bend>& bends() const { return bends_; }

 private:
  struct Directions {
    Real3 to_light, half;  ///< of length 1; half is 0 where there is none
  };
  struct Seen {
    Rgb<double> color;
    std::optional<Directions> constant;  ///< none: a light at a point
    Real3 position;                      ///< of that light
  };

  Directions directions(const Real3& to_light) const;
  Directions directions(const Seen& light, Real t) const;
  void add_kinks_of_point(const Seen& light, bool of_half, const GradientCubics& gradient,
                          Real t_begin, Real length, std::vector<Real>& kinks) const;

  const RealRay& ray_;
  Real3 to_eye_;
  std::vector<Seen> seen_;
  std::vector<Bend> bends_;
};

}  // namespace pellucid::reference
