// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/geometry/ray.h"

namespace pellucid {

/// A pinhole or parallel camera, ready to make rays. Made by `scene` from a checked description.
/// Pixel (column, row) has its origin at the top left; the ray goes through the pixel's centre, has
/// a direction of length 1, and starts at t = 0 at the eye (perspective) or in the plane through
/// the camera's position (parallel).
template <class T>
struct CameraFrame {
  Vec3<T> position;
  Vec3<T> forward;  ///< length 1
  Vec3<T> right,
      up;  ///< length = half the image's extent at distance 1 (perspective) or in the world
  bool perspective = true;
  int width = 0, height = 0;

  PELLUCID_HD Ray<T> ray(int column, int row) const noexcept {
    return ray_through(T(column) + T(0.5), T(row) + T(0.5));
  }

  /// Sample n of samples × samples: the ray through the centre of one of the equal parts of a
  /// pixel.
  PELLUCID_HD Ray<T> ray(int column, int row, int n, int samples) const noexcept {
    const int across = n % samples, down = n / samples;
    return ray_through(T(column) + (T(across) + T(0.5)) / T(samples),
                       T(row) + (T(down) + T(0.5)) / T(samples));
  }

  /// The ray through a point of the image: (0, 0) is its upper left corner, (width, height) its
  /// lower right one.
  PELLUCID_HD Ray<T> ray_through(T column, T row) const noexcept {
    const T x = 2 * column / T(width) - T(1);
    const T y = T(1) - 2 * row / T(height);
    const Vec3<T> offset = right * x + up * y;
    if (perspective) return {position, normalized(forward + offset)};
    return {position + offset, forward};
  }
};

}  // namespace pellucid
