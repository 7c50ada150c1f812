// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "volumes/components.h"

namespace pellucid {

/// Images and rectilinear grids of VTK's: .vti, .pvti, .vtr, .pvtr, and legacy .vtk of such data;
/// an array of points, or one of cells, which is cell-centred. Values that vtkGhostType hides are
/// NaN, in float or double where the type has none.
VolumeFile open_vtk_volume(const std::filesystem::path& path, const ReadOptions& options);
std::vector<VolumeArray> list_vtk_arrays(const std::filesystem::path& path);

}  // namespace pellucid
