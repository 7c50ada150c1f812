// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pellucid/scene/image.h"

namespace pellucid::scenes {

/// How far two images of one size are apart, over all pixels and channels, linear. A value that is
/// not finite in either counts as infinitely far.
struct Difference {
  double largest = 0;
  double rms = 0;
  int column = 0, row = 0, channel = 0;  ///< where the largest is

  std::string text() const;
};

/// Throws std::invalid_argument for images of different sizes or without pixels.
Difference difference(const Image& image, const Image& reference);

/// Largest difference of the half-opacity depths, in world units, over the pixels whose opacity in
/// the reference is at least `opacity`. Infinite where only one of the two has a depth.
double depth_difference(const Image& image, const Image& reference, float opacity);

}  // namespace pellucid::scenes
