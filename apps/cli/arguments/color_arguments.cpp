// SPDX-License-Identifier: Apache-2.0
#include "color_arguments.h"

#include <fmt/format.h>

#include <string_view>
#include <variant>

#include "parse.h"
#include "pellucid/scene/color_map.h"
#include "pellucid/scene/error.h"

namespace pellucid::cli {

namespace {

ColorMap color_map_of(const std::string& name) {
  try {
    return color_map(name);
  } catch (const Error& error) {
    std::string_view message = error.what();
    constexpr std::string_view subject = "color map: ";
    if (message.starts_with(subject)) message.remove_prefix(subject.size());
    throw UsageError(
        fmt::format("--colormap: {} ('pellucid presets --colormaps' lists all)", message));
  }
}

/// Multiplies the extinctions of all terms.
void scale(MultivariateDescription& function, double factor) {
  for (GaussianPrimitive& gaussian : function.gaussians) gaussian.extinction *= factor;
  for (ChannelTransferFunction& table : function.tables) {
    std::vector<TransferFunction::Point> points = table.function.points();
    for (TransferFunction::Point& point : points) point.extinction *= factor;
    table.function = TransferFunction(std::move(points));
  }
}

}  // namespace

void ColorArguments::add_to(CommandLine& command) {
  command
      .add_option("--colormap", colormap,
                  "Color the function by this map of matplotlib, ParaView or Crameri: viridis, "
                  "'cool to warm', batlow, ...; _r behind the name reverses it ('pellucid presets "
                  "--colormaps' lists them)")
      ->option_text("NAME");
  command
      .add_option("--range", range,
                  "Move the first and the last point of the function, and the ends of the color "
                  "map, to these values of the data; with %, below which so many of the values "
                  "are: 2%:98%")
      ->option_text("LOW:HIGH");
  command
      .add_option("--opacity", opacity,
                  "Multiply the extinctions of the function by this factor: above 1 is denser")
      ->option_text("FACTOR");
}

std::string ColorArguments::option_of_a_layer() const {
  if (!colormap.empty()) return "--colormap";
  if (!range.empty()) return "--range";
  return opacity ? "--opacity" : "";
}

void ColorArguments::apply(LayerDescription& layer) const {
  const std::string option = option_of_a_layer();
  if (option.empty()) return;
  if (opacity && !(*opacity >= 0 && *opacity <= 1e9)) {
    throw UsageError(fmt::format("--opacity {}: expected a factor from 0 to 1e9", *opacity));
  }
  if (layer.labels) {
    throw UsageError(option + ": labels have colors of their own; give a table of them");
  }
  auto* const several = layer.transfer_function
                            ? std::get_if<MultivariateDescription>(&*layer.transfer_function)
                            : nullptr;
  const bool without_function = !layer.transfer_function && !layer.channels.empty();
  if (without_function || (several != nullptr && (!colormap.empty() || !range.empty()))) {
    throw UsageError(option +
                     ": is for a function of one variable, but there are several; drop it, or give "
                     "one variable");
  }
  if (several != nullptr) {
    scale(*several, *opacity);
    return;
  }
  FunctionChange& change = layer.function_change;
  if (!colormap.empty()) change.colors = color_map_of(colormap);
  if (!range.empty()) change.range = parse_value_range("--range", range);
  change.opacity = opacity.value_or(1);
}

}  // namespace pellucid::cli
