// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/rgb.h"

namespace pellucid {

/// The effect of a segment of a ray on the light: radiance = L + T · (radiance that enters at its
/// back). The optical depth keeps what the transparency loses by underflow; the opacity keeps what
/// 1 − T loses in thin segments. The four are consistent: transparency = exp(−optical_depth) = 1 −
/// opacity.
template <class T>
struct SegmentResult {
  T optical_depth{};      ///< >= 0
  T opacity{};            ///< in [0, 1]
  T transparency = T(1);  ///< in [0, 1]
  Rgb<T> radiance{};      ///< premultiplied by construction
};

/// Returns the over operator, which is associative: front first (specification, equation 2).
template <class T>
PELLUCID_HD constexpr SegmentResult<T> compose(const SegmentResult<T>& front,
                                               const SegmentResult<T>& back) noexcept {
  return {front.optical_depth + back.optical_depth,
          front.opacity + front.transparency * back.opacity, front.transparency * back.transparency,
          front.radiance + front.transparency * back.radiance};
}

}  // namespace pellucid
