// SPDX-License-Identifier: Apache-2.0
#include "scene_text.h"

namespace pellucid::cli {

std::string scene_text(SceneDescription description, const std::filesystem::path& target) {
  const auto folder = std::filesystem::absolute(target).parent_path();
  visit_paths(description, [&](std::filesystem::path& file) {
    if (file.empty() || !file.is_relative()) return;
    file = std::filesystem::absolute(file).lexically_normal();
    const auto relative = file.lexically_relative(folder.lexically_normal());
    if (!relative.empty()) file = relative;
  });
  return scene_to_json(description);
}

}  // namespace pellucid::cli
