// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "components.h"

namespace pellucid {

/// NIfTI-1: .nii, or .hdr with .img, each also .gz. The world is LPS. The map is the sform where it
/// is the scanner's or stands alone, else the qform (as ITK 5.2 chooses). Colors, and an axis
/// behind the third, are components; several such axes and complex numbers are refused.
VolumeFile open_nifti(const std::filesystem::path& path, const ReadOptions& options);

/// NRRD, attached (.nrrd) or detached (.nhdr), raw, gzip, bzip2, ascii or hex. Turned from RAS or
/// LAS to LPS; other spaces are taken as they are. Cell-centred where all three axes say so. A
/// first or last axis that is none of space, by its kind or for want of a direction, holds
/// components, and so does a fourth axis.
VolumeFile open_nrrd(const std::filesystem::path& path, const ReadOptions& options);

/// MetaImage, .mha or .mhd, raw or zlib; values in one file or in one per slice. Channels and a
/// fourth axis are components.
VolumeFile open_meta_image(const std::filesystem::path& path, const ReadOptions& options);

}  // namespace pellucid
