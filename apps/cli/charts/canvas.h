// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "pellucid/scene/image.h"

namespace pellucid::cli {

/// sRGB, from 0 to 255.
using Color8 = std::array<int, 3>;

struct PixelBox {
  int x = 0, y = 0;  ///< the upper left pixel
  int width = 0, height = 0;
};

/// Characters are drawn of squares of this many pixels.
inline constexpr int text_scale = 2;
inline constexpr int glyph_width = 5, glyph_height = 8;
inline constexpr int character_advance = (glyph_width + 1) * text_scale;
/// Without what hangs below the line.
inline constexpr int text_height = 7 * text_scale;

int text_width(std::string_view text);

/// An opaque picture that is drawn on, for charts. What lies outside of it is left out.
class Canvas {
 public:
  Canvas(int width, int height, Color8 color);

  void fill(const PixelBox& box, Color8 color);
  void fill_linear(const PixelBox& box, const std::array<double, 3>& linear);
  /// Draws a line of one pixel around the box.
  void frame(const PixelBox& box, Color8 color);
  /// Writes in a font of 5 × 7 squares; (x, y) is the upper left pixel. What is not ASCII is a '?'.
  void text(int x, int y, std::string_view text, Color8 color);

  const Image& image() const noexcept { return image_; }

 private:
  Image image_;
};

}  // namespace pellucid::cli
