// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "mesh_blocks.h"

namespace pellucid {

/// A PLOT3D grid of three dimensions, and its solution where `q` is not empty. How the numbers lie
/// in the file is found by its size. Throws Error.
MeshBlocks read_plot3d(const std::filesystem::path& xyz, const std::filesystem::path& q);

}  // namespace pellucid
