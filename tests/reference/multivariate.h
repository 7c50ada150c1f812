// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "pellucid/reference/render.h"
#include "tests/scenes/makers.h"

namespace pellucid::test {

using GridFunction = std::function<double(int i, int j, int k)>;

/// A channel of doubles for each function of the indices.
inline Channels make_channels(const Volume::Description& description,
                              const std::vector<GridFunction>& functions) {
  std::vector<Channel> channels;
  for (const GridFunction& f : functions) {
    channels.push_back({"channel " + std::to_string(channels.size()), "",
                        scenes::make_volume<double>(description, f)});
  }
  return Channels(channels);
}

/// 1/e widths along the axes of the first channels.
inline GaussianPrimitive make_gaussian(const std::vector<double>& center,
                                       const std::vector<double>& widths, double extinction,
                                       Rgb<double> color) {
  GaussianPrimitive g;
  for (std::size_t i = 0; i < center.size(); ++i) g.channels.push_back(static_cast<int>(i));
  g.center = center;
  g.matrix = matrix_from_widths(widths);
  g.extinction = extinction;
  g.color = color;
  return g;
}

/// The largest difference in radiance and opacity.
inline long double apart(const ReferencePixel& p, const std::array<long double, 4>& truth) {
  const std::array<double, 4> pixel{p.radiance.r, p.radiance.g, p.radiance.b, p.opacity};
  long double largest = 0;
  for (std::size_t c = 0; c < 4; ++c) {
    const long double error = std::fabs(static_cast<long double>(pixel[c]) - truth[c]);
    if (!(error <= largest)) largest = error;
  }
  return largest;
}

}  // namespace pellucid::test
