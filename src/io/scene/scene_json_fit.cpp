// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <vector>

#include "pellucid/io/scene_json.h"
#include "scene_json_change.h"

namespace pellucid {

namespace {

/// Returns the most by which light multiplies the error of a color, as approximation_error() counts
/// it.
double light_factor(const Layer& layer, const std::vector<Light>& lights) {
  if (!layer.shading) return 1;
  const double ambient = layer.shading->ambient;
  Rgb<double> sum{ambient, ambient, ambient};
  for (const Light& light : lights) sum += layer.shading->diffuse * light.color;
  return std::max(largest_component(sum), 1.0);
}

}  // namespace

void fit_opacity_tables(const SceneDescription& description, Scene& scene) {
  const auto visible = std::ranges::count_if(scene.layers, &Layer::visible);
  // As approximation_error() counts them.
  const double tolerance =
      scene.integration.tolerance / (visible > 1 ? 2 * static_cast<double>(visible) : 1);
  const auto is_table = [](const TransferFunctionDescription& function) {
    return std::holds_alternative<OpacityTable>(function);
  };
  const double behind_all = brightest_behind(scene);
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    Layer& layer = scene.layers[i];
    auto* const volume = std::get_if<VolumeContent>(&layer.content);
    const bool masked = volume != nullptr && volume->mask;
    const double behind = std::max(behind_all, masked || layer.projection || is_lit(layer)
                                                   ? largest_color(layer, scene.lights)
                                                   : 0);
    const double budget = tolerance / light_factor(layer, scene.lights);
    const auto made = [&](const TransferFunctionDescription& function) {
      // A projection shows an error of the opacity as it is (approximation_error()).
      return std::make_shared<const TransferFunction>(make_transfer_function(
          function, layer.projection ? budget / 8 : budget, Rgb<double>{behind, behind, behind}));
    };
    const std::optional<TransferFunctionDescription> function =
        changed_table(description.layers[i], layer);
    if (function && is_table(*function)) {
      if (volume != nullptr) volume->transfer_function = made(*function);
      if (auto* mesh = std::get_if<MeshContent>(&layer.content)) {
        mesh->transfer_function = made(*function);
      }
    }
    if (!masked) continue;
    std::vector<LabelMask::Choice> choices = volume->mask->choices();
    for (std::size_t k = 0; k < choices.size(); ++k) {
      const TransferFunctionDescription& chosen =
          description.layers[i].mask->choices[k].transfer_function;
      if (is_table(chosen)) choices[k].transfer_function = made(chosen);
    }
    volume->mask = std::make_shared<const LabelMask>(volume->mask->shared_labels(), choices);
  }
}

}  // namespace pellucid
