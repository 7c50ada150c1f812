// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "volumes/components.h"

namespace pellucid {

/// Whether a path is a store of Zarr: a folder with .zarray, .zgroup or zarr.json, or one whose
/// name ends in .zarr; or one of these files.
bool is_zarr(const std::filesystem::path& path);

/// An array of Zarr 2 or 3, or a level of an image of OME-Zarr; of groups with several the named
/// one, else the first. Axes that OME-Zarr, xarray or version 3 name are what they are named,
/// others as array_axes() has them. Channels and times are components.
VolumeFile open_zarr(const std::filesystem::path& path, const ReadOptions& options);

/// The arrays and images of a group; none where the path is an array or an image. Of the options
/// only axes count.
std::vector<VolumeArray> list_zarr_arrays(const std::filesystem::path& path,
                                          const ReadOptions& options);

}  // namespace pellucid
