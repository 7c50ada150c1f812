// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "pellucid/math/rgb.h"

namespace pellucid {

/// Light behind a picture, in linear RGB: from the color at its upper edge to that at its lower
/// edge, linear in sRGB signals between. One color is a background of that color everywhere.
struct Background {
  Rgb<double> top, bottom;

  Background() = default;
  Background(const Rgb<double>& color) : top(color), bottom(color) {}  // NOLINT: one color is one
  Background(const Rgb<double>& upper, const Rgb<double>& lower) : top(upper), bottom(lower) {}

  bool operator==(const Background&) const = default;

  bool is_even() const noexcept { return top == bottom; }
  /// Returns the largest channel of both colors.
  double largest() const noexcept {
    return std::max({top.r, top.g, top.b, bottom.r, bottom.g, bottom.b});
  }
  /// Returns the color in the middle of a row of a picture.
  Rgb<double> at_row(int row, int height) const noexcept;
};

/// Returns the background of a .png that names none: dark, slightly brighter above, so that bright
/// and colored data stand out on white and on black pages.
Background calm_background() noexcept;

}  // namespace pellucid
