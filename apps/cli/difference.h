// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "pellucid/scene/image.h"

namespace pellucid::cli {

/// What |a − b| looks like over a set of numbers. Numbers of which one or both are not finite, and
/// that are not the same, are counted and left out of the rest.
struct DifferenceStatistics {
  double largest = 0;
  double root_mean_square = 0;
  double percentile_999 = 0;  ///< the smallest difference that 99.9 % of all do not exceed
  double psnr = 0;            ///< decibels, for a peak of 1; +infinity where nothing differs
  std::size_t values = 0;     ///< numbers compared, the ones left out included
  std::size_t not_finite = 0;
};

struct ImageDifference {
  std::array<DifferenceStatistics, 4> channel;  ///< red, green, blue, alpha
  DifferenceStatistics all;                     ///< over the four together
  int column = 0, row = 0;  ///< where the largest difference is; the first in reading order
};

/// Of premultiplied linear RGBA. Throws Error where the sizes differ.
ImageDifference compare_images(const Image& a, const Image& b);

/// |a − b| per channel, of the same size; NaN where it is not finite.
Image difference_image(const Image& a, const Image& b);

/// An opaque grey picture of the largest of the four channels' |a − b| times `scale`, cut off at 1;
/// 1 where it is not finite.
Image difference_picture(const Image& a, const Image& b, double scale);

}  // namespace pellucid::cli
