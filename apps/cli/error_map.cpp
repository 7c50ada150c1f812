// SPDX-License-Identifier: Apache-2.0
#include "error_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace pellucid::cli {

namespace {

// matplotlib's viridis (by S. van der Walt and N. Smith, CC0) at 0, 1/8 ... 1: sRGB, 8 bits.
// Lightness grows evenly, also for those who tell few colors apart.
constexpr std::array<std::array<double, 3>, 9> viridis = {{{68, 1, 84},
                                                           {71, 45, 123},
                                                           {59, 82, 139},
                                                           {44, 114, 142},
                                                           {33, 145, 140},
                                                           {40, 174, 128},
                                                           {94, 201, 98},
                                                           {173, 220, 48},
                                                           {253, 231, 37}}};

// IEC 61966-2-1, the way back: 8 bits to linear light.
double linear_of(double signal8) {
  const double s = signal8 / 255;
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

std::array<double, 3> viridis_at(double x) {
  const double place = x * static_cast<double>(viridis.size() - 1);
  const auto lower = std::min(static_cast<std::size_t>(place), viridis.size() - 2);
  const double between = place - static_cast<double>(lower);
  std::array<double, 3> color{};
  for (std::size_t c = 0; c < 3; ++c) {
    color[c] = linear_of(std::lerp(viridis[lower][c], viridis[lower + 1][c], between));
  }
  return color;
}

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
