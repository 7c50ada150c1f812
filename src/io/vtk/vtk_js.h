// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "volumes/components.h"

namespace pellucid {

/// Whether a path is a data set of vtk.js (vtkHttpDataSetReader): a folder with an index.json that
/// has a "vtkClass", or this file.
bool is_vtk_js(const std::filesystem::path& path);

/// An image: an array of points, or one of cells, which is cell-centred.
VolumeFile open_vtk_js(const std::filesystem::path& path, const ReadOptions& options);
std::vector<VolumeArray> list_vtk_js_arrays(const std::filesystem::path& path);

}  // namespace pellucid
