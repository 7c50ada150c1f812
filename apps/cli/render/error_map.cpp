// SPDX-License-Identifier: Apache-2.0
#include "error_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "charts/colors.h"

namespace pellucid::cli {

namespace {

std::array<float, 4> color_of(double share, bool proved) {
  // An error that is just the tolerance may have been rounded upwards to binary32.
  if (!(share <= 1 + 0x1p-22)) return {1, 0, 0, 1};
  std::array<double, 3> color = viridis_at(std::clamp(share, 0.0, 1.0));
  if (!proved) color.fill(0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2]);
  return {static_cast<float>(color[0]), static_cast<float>(color[1]), static_cast<float>(color[2]),
          1};
}

}  // namespace

Image error_picture(const Image& image, double tolerance) {
  Image picture;
  picture.width = image.width;
  picture.height = image.height;
  picture.pixels.reserve(image.error.size());
  for (std::size_t p = 0; p < image.error.size(); ++p) {
    const double error = static_cast<double>(image.error[p]);
    picture.pixels.push_back(color_of(error / tolerance, image.proved[p] != 0));
  }
  return picture;
}

std::string error_scale(double tolerance) {
  return fmt::format(
      "error from 0 (dark) to {} (bright): viridis where proved, grey where estimated, red above",
      tolerance);
}

}  // namespace pellucid::cli
