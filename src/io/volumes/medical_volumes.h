// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "components.h"

namespace pellucid {

/// NIfTI-1 and NIfTI-2: .nii, or .hdr with .img, each also .gz; Analyze 7.5. The world is LPS. The
/// map is the sform where it is the scanner's or stands alone, else the qform (as ITK 5.2 chooses),
/// else what nibabel and SPM take. Colors, and an axis behind the third, are components; several
/// such axes, complex numbers and CIFTI are refused.
VolumeFile open_nifti(const std::filesystem::path& path, const ReadOptions& options);

/// FreeSurfer's .mgz and .mgh. The world is LPS. Frames are components.
VolumeFile open_mgh(const std::filesystem::path& path, const ReadOptions& options);
/// Returns what open_mgh() does of bytes from anywhere, which are not compressed.
VolumeFile open_mgh_bytes(const ByteSource& source, const ReadOptions& options);

/// NRRD, attached (.nrrd) or detached (.nhdr), raw, gzip, bzip2, ascii or hex. Turned from RAS or
/// LAS to LPS; other spaces are taken as they are. Of a space of four axes the fourth is time.
/// Cell-centred where all three axes say so. A first or last axis that is none of space, by its
/// kind or for want of a direction, holds components, and so does a fourth axis.
VolumeFile open_nrrd(const std::filesystem::path& path, const ReadOptions& options);

/// MetaImage, .mha or .mhd, raw or zlib; values in one file or in one per slice. Channels and a
/// fourth axis are components.
VolumeFile open_meta_image(const std::filesystem::path& path, const ReadOptions& options);

}  // namespace pellucid
