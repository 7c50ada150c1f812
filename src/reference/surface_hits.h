// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "light/lit_layer.h"

namespace pellucid::reference {

/// Crossing of a ray and a surface.
struct SurfaceHit {
  Real t;  ///< world arc length
  double opacity;
  Rgb<double> color;  ///< in the light
};

/// Adds where a ray meets the isosurfaces and slices of a layer, in no order.
///
/// The sign of data - value is followed along stretches that join, and a surface is where it turns:
/// values within rounding of the surface's have no sign.
void add_hits(const LitLayer& layer, const std::vector<LayerStretch>& stretches, const RealRay& ray,
              const RayLights& lights, std::vector<SurfaceHit>& hits);

/// Sorts hits from front to back and makes one of those at the same position: a mixture, in which
/// each counts by -log(1 - opacity), or the mean of the opaque ones.
std::vector<SurfaceHit> merged(std::vector<SurfaceHit> hits, const RealRay& ray);

}  // namespace pellucid::reference
