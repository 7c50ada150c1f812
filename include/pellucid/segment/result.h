// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/rgb.h"

namespace pellucid {

/// What a stretch of a ray does to the light: radiance = L + T · (what enters at its back).
/// Optical depth keeps what transparency loses by underflow; opacity keeps what 1 − T loses in thin
/// segments. The four agree: transparency = exp(−optical_depth) = 1 − opacity.
template <class T>
struct SegmentResult {
  T optical_depth{};      ///< >= 0
  T opacity{};            ///< in [0, 1]
  T transparency = T(1);  ///< in [0, 1]
  Rgb<T> radiance{};      ///< premultiplied by construction
};

/// The over operator, associative: front first (specification, equation 2).
template <class T>
PELLUCID_HD constexpr SegmentResult<T> compose(const SegmentResult<T>& front,
                                               const SegmentResult<T>& back) noexcept {
  return {front.optical_depth + back.optical_depth,
          front.opacity + front.transparency * back.opacity, front.transparency * back.transparency,
          front.radiance + front.transparency * back.radiance};
}

}  // namespace pellucid
