// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "pellucid/io/read_volume.h"

namespace pellucid {

/// NIfTI-1: .nii, or .hdr with .img, each also .gz. The world is LPS. Where ITK finds no orthogonal
/// axes, the sform is taken as it is written. Several time steps, colors, complex numbers and
/// 64-bit integers are refused.
Volume read_nifti(const std::filesystem::path& path, const ReadOptions& options);

/// NRRD, attached (.nrrd) or detached (.nhdr), raw, gzip, ascii or hex. Turned from RAS or LAS to
/// LPS; other spaces are taken as they are. Cell-centred where all three axes say so.
Volume read_nrrd(const std::filesystem::path& path, const ReadOptions& options);

/// MetaImage, .mha or .mhd, raw or zlib; values in one file or in one per slice.
Volume read_meta_image(const std::filesystem::path& path, const ReadOptions& options);

}  // namespace pellucid
