// SPDX-License-Identifier: Apache-2.0
#include "tests/scenes/difference.h"

#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>

namespace pellucid::scenes {

std::string Difference::text() const {
  char line[128];
  std::snprintf(line, sizeof line, "largest %.2e, RMS %.2e, worst: column %d, row %d, %c", largest,
                rms, column, row, "RGBA"[channel]);
  return line;
}

Difference difference(const Image& image, const Image& reference) {
  if (image.width != reference.width || image.height != reference.height || image.pixels.empty()) {
    throw std::invalid_argument("images to be compared must have one size and some pixels");
  }
  Difference result;
  double sum = 0;
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      for (std::size_t c = 0; c < 4; ++c) {
        double error = std::fabs(static_cast<double>(image.at(column, row)[c]) -
                                 static_cast<double>(reference.at(column, row)[c]));
        if (!std::isfinite(error)) error = std::numeric_limits<double>::infinity();
        sum += error * error;
        if (error > result.largest) {
          result.largest = error;
          result.column = column;
          result.row = row;
          result.channel = static_cast<int>(c);
        }
      }
    }
  }
  result.rms = std::sqrt(sum / static_cast<double>(4 * image.pixels.size()));
  return result;
}

double depth_difference(const Image& image, const Image& reference, float opacity) {
  if (image.depth.size() != reference.pixels.size() ||
      reference.depth.size() != reference.pixels.size()) {
    throw std::invalid_argument("both images must have a depth for every pixel");
  }
  double largest = 0;
  for (std::size_t i = 0; i < reference.depth.size(); ++i) {
    if (reference.pixels[i][3] < opacity) continue;
    const double error =
        std::fabs(static_cast<double>(image.depth[i]) - static_cast<double>(reference.depth[i]));
    // Written so that a NaN (two infinities, or one) is not passed over.
    if (!(error <= largest)) {
      largest = std::isfinite(error) ? error : std::numeric_limits<double>::infinity();
    }
  }
  return largest;
}

}  // namespace pellucid::scenes
