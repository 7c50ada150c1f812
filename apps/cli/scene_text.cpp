// SPDX-License-Identifier: Apache-2.0
#include "scene_text.h"

#include <variant>

namespace pellucid::cli {

std::string scene_text(SceneDescription description, const std::filesystem::path& target) {
  const auto folder = std::filesystem::absolute(target).parent_path();
  const auto relocate = [&](std::filesystem::path& file) {
    if (file.empty() || !file.is_relative()) return;
    file = std::filesystem::absolute(file).lexically_normal();
    const auto relative = file.lexically_relative(folder.lexically_normal());
    if (!relative.empty()) file = relative;
  };
  for (LayerDescription& layer : description.layers) {
    relocate(layer.field.file);
    if (layer.mesh) {
      relocate(layer.mesh->file);
      relocate(layer.mesh->options.q);
    }
    for (ChannelSource& channel : layer.channels) {
      if (auto* field = std::get_if<FieldSource>(&channel.source)) relocate(field->file);
    }
    if (layer.labels) {
      relocate(layer.labels->field.file);
      relocate(layer.labels->table);
    }
    if (layer.mask) relocate(layer.mask->field.file);
  }
  relocate(description.backdrop);
  return scene_to_json(description);
}

}  // namespace pellucid::cli
