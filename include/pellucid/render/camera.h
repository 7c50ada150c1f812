// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/geometry/ray.h"

namespace pellucid {

/// A pinhole or parallel camera that makes rays. make_camera_frame() in `scene` makes it from a
/// checked description. Pixel (0, 0) is at the top left. A pixel's ray passes through its centre,
/// has a direction of length 1, and starts with t = 0 at the eye (perspective) or in the plane
/// through the camera's position (parallel).
template <class T>
struct CameraFrame {
  Vec3<T> position;
  Vec3<T> forward;  ///< length 1
  /// Half of the image's extent, at distance 1 (perspective) or in the world (parallel).
  Vec3<T> right,
      up;  ///< length = half the image's extent at distance 1 (perspective) or in the world
  bool perspective = true;
  int width = 0, height = 0;

  /// Returns the ray through the pixel's centre.
  PELLUCID_HD Ray<T> ray(int column, int row) const noexcept {
    return ray_through(T(column) + T(0.5), T(row) + T(0.5));
  }

  /// Returns the ray of sample n of samples × samples: it passes through the centre of one of the
  /// equal parts of the pixel.
  PELLUCID_HD Ray<T> ray(int column, int row, int n, int samples) const noexcept {
    const int across = n % samples, down = n / samples;
    return ray_through(T(column) + (T(across) + T(0.5)) / T(samples),
                       T(row) + (T(down) + T(0.5)) / T(samples));
  }

  /// Returns the ray through a point of the image: (0, 0) is its upper left corner, (width, height)
  /// its lower right corner.
  PELLUCID_HD Ray<T> ray_through(T column, T row) const noexcept {
    const T x = 2 * column / T(width) - T(1);
    const T y = T(1) - 2 * row / T(height);
    const Vec3<T> offset = right * x + up * y;
    if (perspective) return {position, normalized(forward + offset)};
    return {position + offset, forward};
  }
};

}  // namespace pellucid
