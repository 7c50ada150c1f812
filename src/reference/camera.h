// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/scene/scene.h"
#include "real.h"

namespace pellucid::reference {

/// Makes the rays of a checked camera description, in world space.
class CameraRays {
 public:
  CameraRays(const Camera& camera, ImageSize size);

  /// Returns the ray of sample n of samples × samples, row by row: through the centre of one of the
  /// equal parts of the pixel (origin of the image at the top left); direction of length 1.
  RealRay ray(int column, int row, int n, int samples) const;

 private:
  Real3 position_, forward_, right_, up_;
  Real half_width_, half_height_;  ///< at distance 1 (perspective), in the world (orthographic)
  bool perspective_;
  Real width_, height_;
};

}  // namespace pellucid::reference
