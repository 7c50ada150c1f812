// SPDX-License-Identifier: Apache-2.0
#include "view_input.h"

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pellucid/io/film.h"
#include "pellucid/io/internal/atomic_file.h"
#include "pellucid/io/internal/color_data.h"
#include "pellucid/io/read_mesh.h"
#include "pellucid/io/remake_scene.h"
#include "suggestions.h"

namespace pellucid::view {

namespace {

namespace fs = std::filesystem;

bool is_scene(const fs::path& path) {
  return path.extension() == ".json" && !is_volume_json(path);
}

SceneDescription describe(const std::string& input, const std::shared_ptr<Look>& look) {
  const fs::path path = input;
  if (is_scene(path))
    return parse_scene(read_text_file(path), path.filename().string(), path.parent_path());
  SceneDescription description;
  LayerDescription& layer = description.layers.front();
  if (!input.starts_with("builtin:") && is_mesh_file(path)) {
    layer.mesh = MeshSource{path, {}, {}};
  } else {
    layer.field = parse_field_source(input);
    show_own_colors(layer);
  }
  if (!layer.transfer_function) {
    layer.look.emplace().chosen = [look](const Look& chosen) { *look = chosen; };
  }
  return description;
}

}  // namespace

ViewedScene view_input(const std::string& input, const ParallelFor& parallel) {
  const auto look = std::make_shared<Look>();
  ViewedScene viewed;
  SceneDescription& description = viewed.description;
  description = describe(input, look);
  resolve_time(description);
  set_first_step(description);
  viewed.keeps_camera = description.camera.has_value();
  const std::vector<std::optional<Layer>> loaded =
      suggest_missing_functions(description, parallel, [](std::vector<ChannelSource>&) {});
  std::vector<MeshSource> meshes;
  viewed.scene = remake_scene(description, loaded, parallel, &meshes);
  Scene& scene = viewed.scene;
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    LayerDescription& layer = description.layers[i];
    if (layer.mesh) layer.mesh = meshes[i];
    complete_description(scene.layers[i], layer);
    if (i < loaded.size() && loaded[i]) viewed.quick_layers.push_back(i);
  }
  check_data(scene);
  description.integration.relative_tolerance.reset();  // the page has a tolerance of its own
  scene.integration = description.integration;
  description.camera = scene.camera;
  if (look->shading) {
    scene.lights = look_lights(scene.camera);
    description.lights = scene.lights;
  }
  return viewed;
}

}  // namespace pellucid::view
