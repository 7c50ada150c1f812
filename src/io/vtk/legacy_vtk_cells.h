// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace pellucid {

/// Throws Error where the lists of cells in a legacy VTK file are not as long as they say: VTK 9.1
/// writes beyond its memory there.
void check_legacy_vtk_cells(const std::filesystem::path& path);

}  // namespace pellucid
