// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pellucid/scene/transfer_function.h"

namespace pellucid {

/// Colors over positions from 0 to 1, ascending; linear in linear light between them.
struct ColorMapPoint {
  double position = 0;
  Rgb<double> color{};  ///< linear RGB
};
using ColorMap = std::vector<ColorMapPoint>;

/// Returns the names of all color maps: those of matplotlib ("viridis"), ParaView ("cool to warm",
/// its default) and Crameri ("batlow") that are in common use.
std::vector<std::string> color_map_names();
/// Returns the color map of this name. Case, spaces, '-', '_' and brackets do not matter; "_r"
/// behind a name reverses the map; gray is grey. Its colors differ from the source's by less than 1
/// of 255 of any sRGB channel, between the points as well: there are 10 to 70 of them, chosen for
/// that. Throws Error if there is none of the name; the message has the names that are near.
ColorMap color_map(std::string_view name);
/// Tells whether color_map() has a map of this name.
bool is_color_map(std::string_view name) noexcept;
/// Returns the colors in reverse order.
ColorMap reversed(const ColorMap& map);
/// Returns the color at a position. Positions outside of [0, 1] have that of the nearest end.
Rgb<double> color_at(const ColorMap& map, double position) noexcept;

/// Returns a function with the extinctions of `function` and the colors of a map between two
/// values, first < last; outside of them the colors of its ends. The extinctions do not change:
/// points are added where the map has some. Throws Error if the range is not two ascending numbers
/// up to 2.1e37.
TransferFunction with_colors(const TransferFunction& function, const ColorMap& map,
                             const std::array<double, 2>& range);
/// Returns the first and the last value between which the function absorbs, or if it absorbs
/// nowhere, or at a single value, its first and last points; at one value a range about that.
std::array<double, 2> absorbing_range(const TransferFunction& function);
/// Returns a function whose first and last points are at these values; the others keep their place
/// between them. A function of one point, or of points at one value, becomes one over the range.
/// Throws Error as with_colors().
TransferFunction moved_to_range(const TransferFunction& function,
                                const std::array<double, 2>& range);
/// Returns the function with its extinctions times a factor >= 0. Throws Error if one is then too
/// large.
TransferFunction with_opacity(const TransferFunction& function, double factor);

}  // namespace pellucid
