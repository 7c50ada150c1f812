// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/math/rgb.h"

namespace pellucid {

/// Returns the color of lightness, chroma and hue (degrees) in Oklab (Ottosson 2020), linear RGB;
/// what sRGB cannot show loses chroma until it can.
Rgb<double> oklch_color(double lightness, double chroma, double hue);

/// Returns a color for each of the numbers, which say how vivid it is to be, from 0 (muted) to 1.
/// Hues are spread evenly around the circle, from orange on: as far apart, to the eye, as they can
/// be.
std::vector<Rgb<double>> distinct_colors(const std::vector<double>& vividness);

}  // namespace pellucid
