// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "pellucid/io/scene_json.h"

namespace pellucid::cli {

/// Returns the scene as JSON, with the paths of its files as seen from the folder of `target`.
std::string scene_text(SceneDescription description, const std::filesystem::path& target);

}  // namespace pellucid::cli
