// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "pellucid/io/scene_json.h"

namespace pellucid {

/// Colors at the points of a file: sRGB signals red, green and blue of bytes or of 16 bits, perhaps
/// with an opacity behind them.
struct ColorOutline {
  int components = 0;  ///< 3 or 4; 0: the file holds no colors
  double largest = 0;  ///< the number of full light: 255 or 65535
  double chord = 0;    ///< mean length of the chords of the data's box, in world units
};

/// Returns what the header of a file says. Reads no values. Throws Error as read_volume() does.
ColorOutline outline_colors(const std::filesystem::path& path, const ReadOptions& options = {});

/// Name of a component that is made of colors, for ReadOptions::component_name: the opacity of RGBA
/// over its largest number, or if that is the same everywhere, or there is none, the luminance of
/// the color as an sRGB signal; f32 in [0, 1].
inline constexpr const char* color_opacity = "opacity";

/// Makes a layer without channels and function, whose field is a file of colors and names no
/// component, one that shows each point in its own color: channels red, green, blue and opacity,
/// and a function of them. Returns whether the file holds colors. Throws Error.
///
/// The color is that of the point, to within 1 of 255 of any sRGB channel. The extinction is linear
/// in the opacity: 0 up to 0.08, which is noise of a dark background, and at 1 an optical depth of
/// 20 along the mean chord of the data's box; of RGBA from 0 on, and 60.
bool show_own_colors(LayerDescription& layer);

}  // namespace pellucid
