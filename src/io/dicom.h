// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "components.h"

namespace pellucid {

/// A DICOM series: a folder with its files, or any one of them. One file per slice, or frames with
/// functional groups; sorted by position. The world is LPS, in millimetres. Values are those behind
/// rescale slope and intercept. Colors are components. Compressed pixels go through GDCM.
VolumeFile open_dicom(const std::filesystem::path& path, const ReadOptions& options);

}  // namespace pellucid
