// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/background.h"

#include "pellucid/scene/srgb.h"

namespace pellucid {

Rgb<double> Background::at_row(int row, int height) const noexcept {
  if (is_even()) return top;
  const double at = (row + 0.5) / height;
  return srgb_to_linear(linear_to_srgb(top) * (1 - at) + linear_to_srgb(bottom) * at);
}

Background calm_background() noexcept {
  constexpr Rgb<double> upper{48.0 / 255, 54.0 / 255, 64.0 / 255};
  constexpr Rgb<double> lower{16.0 / 255, 18.0 / 255, 22.0 / 255};
  return {srgb_to_linear(upper), srgb_to_linear(lower)};
}

}  // namespace pellucid
