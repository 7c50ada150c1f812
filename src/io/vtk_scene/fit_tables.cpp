// SPDX-License-Identifier: Apache-2.0
#include "fit_tables.h"

#include <memory>

#include "pellucid/io/scene_json.h"

namespace pellucid::vtk_scene {

void fit_tables(const std::vector<std::optional<OpacityTable>>& tables, Scene& scene,
                KeptFits& kept) {
  SceneDescription description;
  description.layers.resize(scene.layers.size());
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    LayerDescription& layer = description.layers[i];
    if (tables[i]) layer.transfer_function = *tables[i];
    const auto* const volume = std::get_if<VolumeContent>(&scene.layers[i].content);
    if (volume == nullptr || !volume->mask) continue;
    layer.mask.emplace();
    for (const LabelMask::Choice& choice : volume->mask->choices()) {
      layer.mask->choices.push_back({choice.label, choice.transfer_function->points()});
    }
  }
  fit_opacity_tables(description, scene);
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    if (!tables[i]) continue;
    auto& function = std::get<VolumeContent>(scene.layers[i].content).transfer_function;
    const FunctionNumbers numbers{function->points(), function->relative_error(),
                                  function->color_error()};
    function = kept.find(numbers, [&](const FunctionNumbers&) { return function; });
  }
}

}  // namespace pellucid::vtk_scene
