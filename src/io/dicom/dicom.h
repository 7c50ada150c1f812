// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "dicom_slices.h"
#include "volumes/components.h"

namespace pellucid {

/// A DICOM series: a folder with its files, or any one of them. One file per slice, or frames with
/// functional groups or a vector of their positions; sorted by position. The world is LPS, in
/// millimetres. Values are those behind rescale slope and intercept, or the scaling of a dose.
/// Colors are components. Compressed pixels go through GDCM. Damaged files of a folder are left
/// out, and `options.note` is told.
VolumeFile open_dicom(const std::filesystem::path& path, const ReadOptions& options);

/// The same where reading threw DamagedDicom with these files: they are left out, too.
VolumeFile open_dicom_without(const std::vector<DamagedDicomFile>& damaged,
                              const std::filesystem::path& path, const ReadOptions& options);

}  // namespace pellucid
