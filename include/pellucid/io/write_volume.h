// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "pellucid/scene/volume.h"

namespace pellucid {

/// Returns whether the extension is one that write_volume() writes: .nrrd, .nii, .nii.gz, .npz,
/// .vti, .raw.
bool is_writable_volume(const std::filesystem::path& path);
/// Returns ".nrrd .nii …" for messages and help.
std::string writable_volume_extensions();

/// Writes the components of a volume, which share grid and type, interleaved (.nii: one after the
/// other), in their own type and this machine's byte order, complete or not at all:
///
/// - .nrrd: centering and affine placement are kept; the space is LPS.
/// - .nii, .nii.gz (NIfTI-1): placement in binary32, converted from LPS to RAS; no centering; at
///   most 32767 values along an axis.
/// - .npz (NumPy): the array, and beside it "affine" or, of rectilinear axes, positions "x", "y",
///   "z"; no centering of uniform grids.
/// - .vti (VTK XML, raw appended; Direction needs VTK 9 to read): everything is kept. `array` is
///   the array's name.
/// - .raw: the values alone.
///
/// Returns messages, one line each, about what the format cannot hold and which options make up for
/// it when the file is read. Throws Error if the extension is none of these, an axis is
/// rectilinear (.npz: and turned), components do not agree, or the file cannot be written.
std::vector<std::string> write_volume(std::span<const Volume> components,
                                      const std::filesystem::path& path,
                                      const std::string& array = "values");

}  // namespace pellucid
