// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "pellucid/scene/volume.h"

namespace pellucid {

/// Whether the name is one of a volume that can be written: .nrrd, .nii, .nii.gz, .vti, .raw.
bool is_writable_volume(const std::filesystem::path& path);
/// ".nrrd .nii …", for messages and help.
std::string writable_volume_extensions();

/// Writes the components of a volume, on one grid and of one type, side by side (.nii: one behind
/// the other), in their own type and in this machine's byte order, the file whole or not at all:
///
/// - .nrrd: centering and affine placement as they are; the world is called LPS.
/// - .nii, .nii.gz (NIfTI-1): placement in binary32, from LPS to RAS; no centering; at most 32767
///   values along an axis.
/// - .vti (VTK's XML, raw appended; Direction needs VTK 9 to read): all as it is. `array` is its
///   array's name.
/// - .raw: the values alone.
///
/// Gives what the format does not hold, and what to do about it when the file is read, in lines of
/// their own. Throws Error where the extension is none of these, the values stand at positions of
/// their own along an axis (rectilinear), components do not agree, or the file cannot be written.
std::vector<std::string> write_volume(std::span<const Volume> components,
                                      const std::filesystem::path& path,
                                      const std::string& array = "values");

}  // namespace pellucid
