// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace pellucid {

/// Returns whether a path is a store of Zarr: a folder with .zarray, .zgroup or zarr.json, or one
/// whose name ends in .zarr; or one of these files.
bool is_zarr(const std::filesystem::path& path);

}  // namespace pellucid
