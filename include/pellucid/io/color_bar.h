// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "pellucid/io/scene_json.h"
#include "pellucid/scene/image.h"

namespace pellucid {

/// Legend of a layer: the colors of its values, of its surfaces or of its labels.
struct ColorBar {
  struct Entry {
    std::string name;
    Rgb<double> color{};  ///< linear RGB
  };

  std::string title;  ///< the variable's name, and its unit in brackets; may be empty
  std::shared_ptr<const TransferFunction> function;  ///< null: no bar, entries alone
  std::array<double, 2> range{};                     ///< of the values of the bar
  bool shows_opacity = true;                         ///< whether extinctions mean something
  std::vector<Entry> entries;
};

/// Returns the name of a layer's variable, and behind it its unit in brackets: of a layer with a
/// name that, else the name of the array, or of the file. `channel`: of several variables.
std::string variable_title(const LayerDescription& description, const Layer& layer,
                           int channel = 0);
/// Returns the legends of the visible layers, in their order: one of the function of one variable
/// if it absorbs or colors slices, with isosurfaces as entries; of a function of several variables
/// one for each term of one of them, and an entry for each Gaussian; the colors of slices; and of
/// labels an entry each. Empty if there is nothing to say.
std::vector<ColorBar> color_bars(const SceneDescription& description, const Scene& scene);

/// Message where there is none.
inline constexpr const char* no_color_bars =
    "no color bar: it shows functions, surfaces and labels, but there are none";

/// Colors of a bar at the middles of equal parts of its range, from the least value on.
struct BarSamples {
  std::vector<Rgb<double>> colors;  ///< linear RGB, clamped to [0, 1]
  /// Opacities of a length in which the densest value has an optical depth of 3; empty if the
  /// extinctions mean nothing, or are 0.
  std::vector<double> opacity;
};
/// Returns so many samples of a bar; none of one without a function.
BarSamples sample_bar(const ColorBar& bar, int count);

/// Returns the picture with legends over its right edge, composited over its pixels; depth, error
/// and values are left out. Text is drawn by Cairo in a module. Throws Error if that is not there
/// or cannot draw.
Image with_color_bars(const Image& image, const std::vector<ColorBar>& bars);
/// Throws Error if with_color_bars() cannot draw: to be called before a long computation.
void check_draws_color_bars();

}  // namespace pellucid
