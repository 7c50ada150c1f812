// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "real.h"

namespace pellucid::reference {

/// On which side of edges a ray passes. A ray that meets an edge is thought of as moved aside along
/// two axes of the world, along the second by infinitely less than along the first, so that it
/// meets none: it crosses every closed surface evenly, and passes from tetrahedron to tetrahedron.
class EdgeSides {
 public:
  explicit EdgeSides(const RealRay& ray);

  /// d · ((a - o) × (b - a)) for a ray o + t d: twice the area that the ray and the edge span, seen
  /// along the ray.
  struct Side {
    Real area;
    /// Sign of the area, or where that is 0 of that of the moved ray; 0 for edges parallel to the
    /// ray.
    int sign;
    bool certain;  ///< else neither sign nor area are known well enough
  };

  /// Tells the side in extended precision.
  Side quick(const Real3& a, const Real3& b) const;
  /// Tells the side in as many bits as it takes (512: factors of 170). Certain.
  Side exact(const Real3& a, const Real3& b) const;

 private:
  RealRay ray_;
  std::size_t first_, second_;  ///< the axes that the ray is moved along
};

}  // namespace pellucid::reference
