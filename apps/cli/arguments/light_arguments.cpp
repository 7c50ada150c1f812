// SPDX-License-Identifier: Apache-2.0
#include "light_arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "parse.h"

namespace pellucid::cli {

void LightArguments::add_to(CommandLine& command) {
  command
      .add_option(
          "--shading", shading,
          "Light INPUT: on, off, or AMBIENT,DIFFUSE,SPECULAR[,POWER]; on is 0.2,0.7,0.2,20. "
          "Default: the scene's, else that of --tf, else off; with --iso on")
      ->option_text("VALUES");
  command
      .add_option("--light", lights,
                  "Add a light in place of the scene's; may be repeated. SPEC is head, "
                  "directional:X,Y,Z or point:X,Y,Z in world coordinates, and perhaps :COLOR as "
                  "--background. Default: the scene's, else a white head light")
      ->option_text("SPEC")
      ->allow_extra_args(false);
  command
      .add_option("--iso", isosurfaces,
                  "Add the surface of this value of INPUT, as VALUE[:COLOR[:OPACITY]]; may be "
                  "repeated. Without a transfer function only surfaces are shown")
      ->option_text("VALUE")
      ->allow_extra_args(false);
  command
      .add_option("--slice", slices,
                  "Add a plane that shows INPUT in colors; may be repeated. PLANE is x=VALUE, "
                  "y=VALUE, z=VALUE or X,Y,Z,NX,NY,NZ in world coordinates, and perhaps :OPACITY. "
                  "Without a transfer function it is grey, and only surfaces are shown")
      ->option_text("PLANE")
      ->allow_extra_args(false);
}

std::string LightArguments::option_of_a_layer() const {
  return !isosurfaces.empty() ? "--iso"
         : !slices.empty()    ? "--slice"
         : !shading.empty()   ? "--shading"
                              : "";
}

void LightArguments::apply(LayerDescription& layer) const {
  const std::string option = option_of_a_layer();
  if (!option.empty() && layer.labels) {
    throw UsageError(option + ": labels have no light and no surfaces; drop it");
  }
  if (!option.empty() && layer.projection && shading != "off") {
    throw UsageError(option +
                     ": a projected layer has no light and no surfaces; drop it or --projection");
  }
  for (const std::string& text : isosurfaces) {
    Isosurface surface = parse_isosurface("--iso", text);
    const auto is_same = [&](const Isosurface& other) {
      return other.value == surface.value && other.channel == surface.channel;
    };
    if (std::ranges::any_of(layer.isosurfaces, is_same)) {
      throw UsageError(fmt::format("--iso '{}': there is an isosurface of {} already; drop it",
                                   text, surface.value));
    }
    layer.isosurfaces.push_back(std::move(surface));
  }
  for (const std::string& text : slices) layer.slices.push_back(parse_slice("--slice", text));
  if (shading == "off") {
    layer.shading.reset();
    return;
  }
  const bool wanted = !shading.empty() || !isosurfaces.empty();
  if (wanted && !layer.shading) layer.shading.emplace();
  if (shading.empty() || shading == "on") return;
  const Shading given = parse_shading("--shading", shading);
  Shading& values = *layer.shading;
  values.ambient = given.ambient;
  values.diffuse = given.diffuse;
  values.specular = given.specular;
  if (std::ranges::count(shading, ',') == 3) values.power = given.power;
}

void LightArguments::apply(SceneDescription& scene) const {
  if (!lights.empty()) scene.lights.clear();
  for (const std::string& text : lights) scene.lights.push_back(parse_light("--light", text));
}

void take_look(const std::optional<Shading>& shading,
               const std::shared_ptr<const GradientOpacity>& gradient_opacity,
               const std::string& file, LayerDescription& layer, std::vector<std::string>& notes) {
  if (!shading && !gradient_opacity) return;
  if (layer.projection || layer.labels) {
    notes.push_back(fmt::format("{}: shading and gradient opacity are left out, for {} no light",
                                file, layer.labels ? "labels have" : "a projected layer has"));
    return;
  }
  if (!layer.shading) layer.shading = shading;
  if (!layer.gradient_opacity) layer.gradient_opacity = gradient_opacity;
}

}  // namespace pellucid::cli
