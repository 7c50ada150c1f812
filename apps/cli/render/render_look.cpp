// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "arguments/parse.h"
#include "pellucid/scene/color_map.h"
#include "pellucid/scene/look.h"
#include "render.h"

namespace pellucid::cli {

namespace {

/// Returns their names but for one, with commas between.
std::string names_of(std::span<const LookName> looks, std::string_view but = {}) {
  std::string names;
  for (const LookName& look : looks) {
    if (look.name != but) names += (names.empty() ? "" : ", ") + std::string(look.name);
  }
  return names;
}

/// Throws UsageError where something else says what is shown.
void refuse_beside_look(const RenderArguments& arguments) {
  const std::pair<const char*, bool> given[] = {{"--tf", !arguments.transfer_function.empty()},
                                                {"--preset", !arguments.preset.empty()},
                                                {"--gaussian", !arguments.gaussians.empty()},
                                                {"--channel", !arguments.channels.empty()},
                                                {"--projection", !arguments.projection.empty()},
                                                {"--iso", !arguments.light.isosurfaces.empty()},
                                                {"--slice", !arguments.light.slices.empty()},
                                                {"a scene", arguments.is_scene()}};
  for (const auto& [what, is_given] : given) {
    if (is_given) {
      throw UsageError(
          fmt::format("--look: {} says what is shown; leave one of the two out", what));
    }
  }
}

/// A volume around labels is a tenth as dense as one that is looked at itself, and grey: the colors
/// are those of the labels.
constexpr double context_opacity = 0.1;

/// Returns whether the first layer is a volume that nothing says the look of, and all others are
/// labels.
bool is_context_of_labels(const RenderArguments& arguments, const PreparedScene& prepared) {
  const std::vector<LayerDescription>& layers = prepared.description.layers;
  const LayerDescription& first = layers.front();
  return prepared.transfer_function_from == "default" && !arguments.is_scene() &&
         arguments.look.empty() && layers.size() > 1 && !first.mesh && !first.labels &&
         first.channels.empty() && !first.projection &&
         std::all_of(layers.begin() + 1, layers.end(),
                     [](const LayerDescription& layer) { return layer.labels.has_value(); });
}

}  // namespace

void want_look(const RenderArguments& arguments, PreparedScene& prepared) {
  if (!arguments.look.empty()) refuse_beside_look(arguments);
  const bool surfaces_alone = arguments.transfer_function.empty() && arguments.preset.empty() &&
                              !arguments.is_scene() && !arguments.light.isosurfaces.empty();
  if (const std::string option = arguments.colors.option_of_a_layer();
      !option.empty() && surfaces_alone) {
    throw UsageError(option +
                     ": changes a function, but --iso shows surfaces alone; give --iso "
                     "its colors and opacities, or add --tf or --preset");
  }
  const bool is_context = is_context_of_labels(arguments, prepared);
  const bool is_default = prepared.transfer_function_from == "default" && !arguments.is_scene() &&
                          prepared.description.layers.size() == 1;
  if (arguments.look.empty() && !is_default && !is_context) return;
  WantedLook look;
  look.name = is_context ? "haze" : lower_case(arguments.look);
  if (is_context) {
    FunctionChange& change = prepared.description.layers.front().function_change;
    change.opacity *= context_opacity;
    if (change.colors.empty()) change.colors = color_map("gray");
  }
  const auto is_it = [&](const LookName& known) { return known.name == look.name; };
  if (!look.name.empty() && std::ranges::none_of(looks(), is_it) &&
      std::ranges::none_of(looks_of_meshes(), is_it)) {
    throw UsageError(fmt::format("--look {}: unknown; there are {}, and {} of meshes",
                                 arguments.look, names_of(looks()),
                                 looks_of_meshes().front().name));
  }
  look.has_function = arguments.print_tf || !arguments.save_tf.empty();
  look.keeps_shading = !arguments.light.shading.empty();
  prepared.look = std::make_shared<Look>();
  look.chosen = [told = prepared.look, is_context](const Look& chosen) {
    *told = chosen;
    if (is_context) told->reason = "labels inside of it: grey, a tenth as dense";
  };
  prepared.description.layers.front().look = std::move(look);
}

void check_look(const RenderArguments& arguments, const PreparedScene& prepared) {
  if (prepared.look && !prepared.look->isosurfaces.empty() &&
      (arguments.print_tf || !arguments.save_tf.empty())) {
    throw UsageError(
        fmt::format("{}: the look {} has surfaces and no function; --look haze has one",
                    arguments.print_tf ? "--print-tf" : "--save-tf", prepared.look->name));
  }
}

void light_look(const RenderArguments& arguments, PreparedScene& prepared) {
  if (!prepared.look || !prepared.look->shading || !arguments.light.lights.empty()) return;
  prepared.scene.lights = look_lights(prepared.scene.camera);
  prepared.description.lights = prepared.scene.lights;
}

std::string look_line(const PreparedScene& prepared) {
  const Look& look = *prepared.look;
  const bool is_mesh = prepared.description.layers.front().mesh.has_value();
  return fmt::format("look {}{} (--look NAME takes another: {})", look.name,
                     look.reason.empty() ? "" : ", for " + look.reason,
                     names_of(is_mesh ? looks_of_meshes() : looks(), look.name));
}

}  // namespace pellucid::cli
