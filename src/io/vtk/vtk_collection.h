// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "volumes/components.h"

namespace pellucid {

/// Returns whether a file of VTK's lists others (.vtm, .vtmb, .pvd) of which one is an image or a
/// rectilinear grid, or is adaptive (.vthb, .vth, also .vtm): then it is no mesh.
bool is_image_collection(const std::filesystem::path& path);

/// The grid, where it lists nothing else. Throws Error where it does, or is adaptive.
VolumeFile open_image_collection(const std::filesystem::path& path, const ReadOptions& options);
std::vector<VolumeArray> list_collection_arrays(const std::filesystem::path& path);

}  // namespace pellucid
