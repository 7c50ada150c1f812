// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace pellucid {

/// Result of a ray in a part of the world, as ranks exchange it: premultiplied linear RGBA, its
/// error, and 1 if the error is an estimate, else 0.
struct RayPixel {
  float red = 0, green = 0, blue = 0, opacity = 0;
  float error = 0, estimated = 0;
};

/// Returns whether nothing was gathered, and that is known.
inline bool is_empty(const RayPixel& pixel) noexcept {
  return pixel.red == 0 && pixel.green == 0 && pixel.blue == 0 && pixel.opacity == 0 &&
         pixel.error == 0 && pixel.estimated == 0;
}

/// Composites a part over the one behind it. Associative, but not commutative. An error is
/// composited as a premultiplied color is, e = e1 + (1 - a1) e2, because the error of a part bounds
/// what it does to everything behind it. The roundings of this function are added to it: at most
/// 2^-23 of the result. With an empty part nothing is rounded.
inline RayPixel over(const RayPixel& front, const RayPixel& behind) noexcept {
  if (is_empty(front)) return behind;
  if (is_empty(behind)) return front;
  const float transparency = 1 - front.opacity;
  RayPixel both;
  both.red = front.red + transparency * behind.red;
  both.green = front.green + transparency * behind.green;
  both.blue = front.blue + transparency * behind.blue;
  both.opacity = front.opacity + transparency * behind.opacity;
  const float brightest = std::max({both.red, both.green, both.blue, both.opacity, 0.0f});
  // An unknown error behind what is opaque is none.
  const float seen = transparency > 0 ? transparency * behind.error : 0.0f;
  both.error = front.error + (seen * (1 + 0x1p-21f) + 0x1p-23f * brightest);
  both.estimated = std::max(front.estimated, behind.estimated);
  return both;
}

}  // namespace pellucid
