// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "pellucid/io/internal/color_data.h"
#include "pellucid/scene/srgb.h"

namespace pellucid {
namespace {

/// Signals where the table of a color has its points. Between them, straight lines are off from the
/// sRGB curve by less than 1 of 255. Each point cuts spans, so there are few.
constexpr double signals[] = {0, 0.065, 0.12, 0.185, 0.26, 0.345, 0.44, 0.55, 0.67, 0.8, 0.94, 1};
/// Optical depths along the mean chord of what is opaque, and the luminance that is still vacuum.
constexpr double depth_of_luminance = 20, depth_of_alpha = 60, dark = 0.08;

/// Returns the table that adds one primary: a third of the extinction, and three times its light.
std::vector<TransferFunction::Point> primary(const Rgb<double>& color, double largest) {
  std::vector<TransferFunction::Point> points;
  for (const double signal : signals) {
    points.push_back({signal * largest, 1.0 / 3, 3 * srgb_to_linear(signal) * color});
  }
  return points;
}

ChannelSource component_of(const FieldSource& field, const std::string& name, int component) {
  FieldSource source = field;
  source.options.component = component;
  return {name, "", source};
}

}  // namespace

bool show_own_colors(LayerDescription& layer) {
  const FieldSource field = layer.field;
  if (field.file.empty() || field.options.component || field.options.component_name) return false;
  const ColorOutline outline = outline_colors(field.file, field.options);
  if (outline.components == 0) return false;
  const char* const names[] = {"red", "green", "blue"};
  const Rgb<double> primaries[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  MultivariateDescription function;
  for (int c = 0; c < 3; ++c) {
    layer.channels.push_back(component_of(field, names[c], c));
    function.tables.push_back({names[c], TransferFunction(primary(primaries[c], outline.largest))});
  }
  FieldSource opacity = field;
  opacity.options.component_name = color_opacity;
  layer.channels.push_back({color_opacity, "", opacity});
  const bool has_alpha = outline.components == 4;
  const double densest = (has_alpha ? depth_of_alpha : depth_of_luminance) / outline.chord;
  function.factor = {color_opacity,
                     TransferFunction({{has_alpha ? 0 : dark, 0, {}}, {1, densest, {}}})};
  layer.transfer_function = std::move(function);
  layer.field = {};
  return true;
}

}  // namespace pellucid
