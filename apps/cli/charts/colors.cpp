// SPDX-License-Identifier: Apache-2.0
#include "colors.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pellucid::cli {

namespace {

// By S. van der Walt and N. Smith, CC0, at 0, 1/8 ... 1: sRGB, 8 bits.
constexpr std::array<std::array<double, 3>, 9> viridis = {{{68, 1, 84},
                                                           {71, 45, 123},
                                                           {59, 82, 139},
                                                           {44, 114, 142},
                                                           {33, 145, 140},
                                                           {40, 174, 128},
                                                           {94, 201, 98},
                                                           {173, 220, 48},
                                                           {253, 231, 37}}};

}  // namespace

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

}  // namespace pellucid::cli
