// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace pellucid {

/// Returns whether a file of VTK's lists others (.vtm, .vtmb, .pvd) of which one is an image or a
/// rectilinear grid, or is adaptive (.vthb, .vth, also .vtm): then it is no mesh.
bool is_image_collection(const std::filesystem::path& path);

}  // namespace pellucid
