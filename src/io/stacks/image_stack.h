// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "volumes/components.h"

namespace pellucid {

/// Whether a path is a pattern of numbered images ("slice%03d.tif") and no file.
bool is_stack_pattern(const std::filesystem::path& path);

/// Whether a path is OME-XML beside the files of pages that it describes (".companion.ome").
bool is_companion(const std::filesystem::path& path);

/// A stack of images (.tif, .tiff, .png): a file of several pages; numbered files, by any of them,
/// by a pattern or by the folder that holds them and no other images. All are of one size and type,
/// and their numbers go up in equal steps. Samples are components. Distances are those of the file
/// where it states a unit, else 1.
VolumeFile open_stack(const std::filesystem::path& path, const ReadOptions& options);

}  // namespace pellucid
