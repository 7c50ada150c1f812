// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "pellucid/scene/background.h"
#include "pellucid/scene/image.h"
#include "pellucid/scene/image_view.h"

namespace pellucid {

/// Layout of a picture's bytes, row after row from the top.
enum class DisplayLayout {
  rgb,   ///< composited over a background
  rgba,  ///< the same, with alpha 255
};

/// Returns a picture as 8-bit sRGB signals over a background, rounded to nearest: the
/// bytes that write_png() writes. Numbers beyond [0, 1] are clamped; NaN counts as 0.
std::vector<std::uint8_t> display_bytes(const Image& image, const Background& background,
                                        DisplayLayout layout = DisplayLayout::rgb);
/// Returns the same of every `stride`-th pixel along each axis, from pixel (0, 0).
std::vector<std::uint8_t> display_bytes(const ImageView& image, const Background& background,
                                        DisplayLayout layout, int stride);
/// Returns sRGB signals and alpha, which is not premultiplied. Pixels without opacity are black.
std::vector<std::uint8_t> transparent_display_bytes(const Image& image);

}  // namespace pellucid
