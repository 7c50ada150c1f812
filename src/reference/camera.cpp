// SPDX-License-Identifier: Apache-2.0
#include "camera.h"

#include <cmath>
#include <numbers>

#include "vectors.h"

namespace pellucid::reference {
CameraRays::CameraRays(const Camera& camera, ImageSize size)
    : position_{camera.position.x, camera.position.y, camera.position.z},
      forward_(unit({camera.focal_point.x - position_[0], camera.focal_point.y - position_[1],
                     camera.focal_point.z - position_[2]})),
      right_(unit(cross(forward_, {camera.up.x, camera.up.y, camera.up.z}))),
      up_(cross(right_, forward_)),
      perspective_(camera.projection == Projection::perspective),
      width_(static_cast<Real>(size.width)),
      height_(static_cast<Real>(size.height)) {
  const Real radians = camera.vertical_angle / Real(180) * std::numbers::pi_v<Real>;
  half_height_ = perspective_ ? std::tan(radians / 2) : camera.parallel_scale;
  half_width_ = half_height_ * width_ / height_;
}

RealRay CameraRays::ray(int column, int row, int n, int samples) const {
  // The centre of a pixel of an image that is finer by the factor `samples`.
  const int fine_column = column * samples + n % samples;
  const int fine_row = row * samples + n / samples;
  const Real x = half_width_ * ((2 * Real(fine_column) + 1) / (width_ * samples) - 1);
  const Real y = half_height_ * (1 - (2 * Real(fine_row) + 1) / (height_ * samples));
  Real3 in_plane;
  for (std::size_t a = 0; a < 3; ++a) in_plane[a] = x * right_[a] + y * up_[a];
  if (perspective_) {
    return {position_, unit({forward_[0] + in_plane[0], forward_[1] + in_plane[1],
                             forward_[2] + in_plane[2]})};
  }
  return {{position_[0] + in_plane[0], position_[1] + in_plane[1], position_[2] + in_plane[2]},
          forward_};
}

}  // namespace pellucid::reference
