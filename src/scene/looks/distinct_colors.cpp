// SPDX-License-Identifier: Apache-2.0
#include "distinct_colors.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pellucid {
namespace {

Rgb<double> linear_of_oklab(double lightness, double a, double b) {
  const auto cube = [](double x) { return x * x * x; };
  const double l = cube(lightness + 0.3963377774 * a + 0.2158037573 * b);
  const double m = cube(lightness - 0.1055613458 * a - 0.0638541728 * b);
  const double s = cube(lightness - 0.0894841775 * a - 1.2914855480 * b);
  return {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
          -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
          -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
}

bool in_gamut(const Rgb<double>& c) {
  constexpr double slack = 1e-6;
  return std::min({c.r, c.g, c.b}) >= -slack && std::max({c.r, c.g, c.b}) <= 1 + slack;
}

}  // namespace

Rgb<double> oklch_color(double lightness, double chroma, double hue) {
  const double angle = hue * std::numbers::pi / 180;
  Rgb<double> color{};
  for (int step = 0; step <= 64; ++step) {
    const double kept = chroma * (64 - step) / 64;
    color = linear_of_oklab(lightness, kept * std::cos(angle), kept * std::sin(angle));
    if (in_gamut(color)) break;
  }
  return {std::clamp(color.r, 0.0, 1.0), std::clamp(color.g, 0.0, 1.0),
          std::clamp(color.b, 0.0, 1.0)};
}

std::vector<Rgb<double>> distinct_colors(const std::vector<double>& vividness) {
  constexpr double first_hue = 60;
  const auto count = static_cast<double>(vividness.size());
  std::vector<Rgb<double>> colors;
  for (const double vivid : vividness) {
    const double hue = first_hue + 360 * static_cast<double>(colors.size()) / count;
    colors.push_back(oklch_color(std::lerp(0.68, 0.8, vivid), std::lerp(0.08, 0.2, vivid), hue));
  }
  return colors;
}

}  // namespace pellucid
