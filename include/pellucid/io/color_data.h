// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "pellucid/io/scene_json.h"

namespace pellucid {

/// What a file says of the colors at its points: sRGB signals red, green and blue of bytes or of 16
/// bits, perhaps with an opacity behind them.
struct ColorOutline {
  int components = 0;  ///< 3 or 4; 0: the file holds no colors
  double largest = 0;  ///< the number of full light: 255 or 65535
  double chord = 0;    ///< mean length of the chords of the data's box, in world units
};

/// Returns what the header of a file says. Reads no values. Throws Error as read_volume() does.
ColorOutline outline_colors(const std::filesystem::path& path, const ReadOptions& options = {});

/// Name of a component that is made of colors, for ReadOptions::component_name; f32 in [0, 1]. It
/// is the opacity of RGBA over its largest number. If that is the same everywhere, or there is
/// none, it is a third of the luminance, as an sRGB signal, from 0 at a signal of 0.08 on, which is
/// noise of a dark background.
inline constexpr const char* color_opacity = "opacity";

/// Makes a layer without channels and function, whose field is a file of colors and names no
/// component, one that shows each point in its own color: channels red, green, blue and opacity,
/// and a function of them. Returns whether the file holds colors. Throws Error.
///
/// The color is that of the point, to within 1 of 255 of any sRGB channel. The extinction is in
/// proportion to the opacity, which makes an optical depth of 60 along the mean chord of the data's
/// box where it is 1.
bool show_own_colors(LayerDescription& layer);
/// Returns whether a layer is one that show_own_colors() made, perhaps edited.
bool shows_own_colors(const LayerDescription& layer);

}  // namespace pellucid
