// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pellucid/io/scene_json.h"

namespace pellucid {

/// Makes a scene as make_scene() does, with the data of the layers in `loaded`, one or none for
/// each layer of the description: of these nothing is read but what remake_layer() would read.
/// `before`, layers of the scene at another time, are taken for what stays: of meshes whose points
/// and cells are equal, the tetrahedra. Throws Error as make_scene() does.
Scene remake_scene(const SceneDescription& description,
                   const std::vector<std::optional<Layer>>& loaded,
                   const ParallelFor& parallel = {}, std::vector<MeshSource>* meshes_used = nullptr,
                   std::span<const Layer> before = {});

}  // namespace pellucid
