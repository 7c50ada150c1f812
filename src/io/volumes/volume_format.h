// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "components.h"
#include "dicom/dicom_slices.h"
#include "pellucid/io/read_volume.h"

namespace pellucid {

/// A format of volume files.
struct VolumeFormat {
  /// Reads a file's header. Throws Error.
  VolumeFile (*open)(const std::filesystem::path& path, const ReadOptions& options);
  /// Lists a file's arrays; null: the format gives them no names. Throws Error.
  std::vector<VolumeArray> (*list)(const std::filesystem::path& path,
                                   const ReadOptions& options) = nullptr;
  /// Opens a DICOM series without the files that turned out to be damaged. Throws Error.
  VolumeFile (*open_without)(const std::vector<DamagedDicomFile>& damaged,
                             const std::filesystem::path& path,
                             const ReadOptions& options) = nullptr;
  bool has_header = true;
  bool takes_axes = false;  ///< whether the options say which axes are x, y and z
  bool has_levels = false;  ///< of resolution
  bool has_times = false;   ///< whether a step is chosen by its time
  bool has_series = false;  ///< whether one of several series or images is chosen
  bool is_of_patients = false;
};

/// A format by the end of a file's name, in small letters.
struct VolumeExtension {
  std::string_view text;
  const VolumeFormat* format;
};

/// Returns the extensions that this build reads.
std::span<const VolumeExtension> volume_format_extensions();

/// Returns the format of files of this name; null: the name tells nothing.
const VolumeFormat* volume_format_by_name(std::string_view file_name);

/// Returns the format of a file or a folder, by its name and its content. Throws Error, with what
/// to do, where it is no volume that this build reads.
const VolumeFormat& find_volume_format(const std::filesystem::path& path,
                                       const ReadOptions& options);

/// Formats that every build reads.
extern const VolumeFormat nifti_format, npy_format, raw_format, raw_gzip_format;

}  // namespace pellucid
