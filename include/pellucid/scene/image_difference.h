// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "pellucid/scene/image.h"

namespace pellucid {

/// Statistics of |a − b| over a set of numbers. Numbers of which one or both are not finite, and
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
  int column = 0, row = 0;  ///< pixel of the largest difference; the first in reading order
};

/// Compares images of premultiplied linear RGBA. Throws Error where the sizes differ.
ImageDifference compare_images(const Image& a, const Image& b);

/// Comparison of a difference with the errors that the images carry.
struct ErrorCheck {
  std::size_t pixels = 0;
  std::size_t over = 0;     ///< differ by more than the errors allow, or are not finite
  std::size_t unknown = 0;  ///< with an error that is infinite or not a number: never over
  std::size_t proved = 0;   ///< whose error is a proved bound
  int column = 0, row = 0;  ///< pixel whose difference exceeds its error by most, or comes closest
  double difference = 0, error = 0;  ///< there

  /// error / difference over the pixels that differ and whose error is known; infinite where there
  /// is none.
  double tightness_median = 0, tightness_smallest = 0;
};

/// Returns the largest difference of a pixel's channels against a's error plus b's; where b carries
/// none it counts as exact but for its rounding to binary32 (2⁻²⁴ of each value). Nothing where a
/// carries none. Throws Error where the sizes differ.
std::optional<ErrorCheck> check_errors(const Image& a, const Image& b);

/// Pixels with a channel that differs by more than the tolerance or is not finite in one image.
std::size_t pixels_over(const Image& a, const Image& b, double tolerance);

/// Returns |a − b| per channel, of the same size; NaN where it is not finite.
Image difference_image(const Image& a, const Image& b);

/// Returns an opaque grey picture of the largest of the four channels' |a − b| times `scale`, cut
/// off at 1; 1 where it is not finite.
Image difference_picture(const Image& a, const Image& b, double scale);

}  // namespace pellucid
