// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "arguments/parse.h"
#include "pellucid/io/import_transfer_function.h"
#include "pellucid/io/internal/atomic_file.h"
#include "pellucid/io/internal/color_data.h"
#include "pellucid/scene/presets.h"
#include "render.h"

namespace pellucid::cli {

namespace {

/// Returns the deviation that an imported function may have, in its color and in its extinction
/// each.
double import_share(const RenderArguments& arguments, const SceneDescription& description) {
  const double tolerance = arguments.tolerance
                               ? parse_tolerance("--tolerance", *arguments.tolerance)
                               : description.integration.tolerance;
  const double smaller = arguments.reference ? std::min(tolerance, reference_tolerance) : tolerance;
  return std::clamp(smaller / 16, smallest_deviation, largest_deviation);
}

/// Returns the values of --range; none: it is not given, or depends on the data.
std::optional<std::array<double, 2>> plain_range(const RenderArguments& arguments) {
  if (arguments.colors.range.empty() || arguments.colors.asks_data()) return std::nullopt;
  const RangeEnds range = parse_value_range("--range", arguments.colors.range);
  return std::array<double, 2>{range[0].number, range[1].number};
}

ImportOptions import_options(const RenderArguments& arguments,
                             const SceneDescription& description) {
  ImportOptions options = arguments.import.options(import_share(arguments, description));
  options.range = plain_range(arguments);
  return options;
}

}  // namespace

void set_own_colors(const RenderArguments& arguments, LayerDescription& layer,
                    std::vector<std::string>& notes) {
  // Functions that are given see one variable, or name channels of their own.
  if (!arguments.takes_own_colors() || !layer.channels.empty() || !show_own_colors(layer)) return;
  notes.push_back(
      "the data are colors: each point has its own, and the opacity of its alpha or luminance "
      "(--component N shows one component, --save-scene FILE.json writes the function)");
}

void set_transfer_function(const RenderArguments& arguments, SceneDescription& description,
                           std::vector<std::string>& import_notes) {
  const std::string& file = arguments.transfer_function;
  if (!arguments.preset.empty()) {
    arguments.import.refuse("a preset");
    if (find_preset(arguments.preset) == nullptr) {
      throw UsageError(fmt::format("--preset {}: unknown preset; 'pellucid presets' lists them",
                                   arguments.preset));
    }
    if (!description.layers.front().channels.empty()) {
      throw UsageError(
          "--preset: presets are for one variable, but there are channels; drop one of the two");
    }
    LayerDescription& layer = description.layers.front();
    layer.transfer_function = PresetDescription{arguments.preset, {}};
    const bool may_be_lit = !layer.projection && arguments.projection.empty();
    if (find_preset(arguments.preset)->lit && may_be_lit && !layer.shading) layer.shading.emplace();
    return;
  }
  const std::string text = file.empty() ? "" : read_text_file(file);
  if (!file.empty() && needs_import(text)) {
    const ImportedTransferFunction imported =
        import_transfer_function(text, file, import_options(arguments, description));
    LayerDescription& layer = description.layers.front();
    layer.transfer_function = imported.table;
    import_notes = import_lines(imported, file);
    take_look(imported.shading, imported.gradient_opacity, file, layer, import_notes);
    return;
  }
  const char* const what =
      file.empty() ? "a scene's own transfer function" : "a transfer function of our own";
  arguments.import.refuse(what);
  if (!file.empty()) {
    LookDescription look = parse_look(text, file);
    LayerDescription& layer = description.layers.front();
    layer.transfer_function = std::move(look.transfer_function);
    take_look(look.shading, look.gradient_opacity, file, layer, import_notes);
  }
}

}  // namespace pellucid::cli
