// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "components.h"
#include "pellucid/io/read_volume.h"
#include "pellucid/io/time_steps.h"

namespace pellucid {

struct DamagedDicomFile;

/// Answer of a format to the content of a file.
enum class ContentOwner {
  others,  ///< nothing
  this_format,
  no_volume  ///< that it is of the format, but no volume: formats are not asked by its name
};

/// A format of volume files: its name, how its files are told from others, and how they are read.
/// Each folder of a format defines such objects and names them in its sources.cmake, from which the
/// table of all formats is made. A pointer that is null says that there is no such function.
struct VolumeFormat {
  std::string_view name = {};        ///< for people
  std::string_view extensions = {};  ///< ends of files' names, in small letters: ".nii .nii.gz"

  // How a path is recognized, in the order in which all formats are asked. Of formats that are
  // asked at once no two may take the same path.
  /// Returns whether any path is of this format: a folder, a file, or what is none of both.
  bool (*takes_path)(const std::filesystem::path& path) = nullptr;
  /// Returns whether a folder is of this format.
  bool (*takes_folder)(const std::filesystem::path& path) = nullptr;
  bool takes_other_folders = false;  ///< that no format takes before
  /// Returns whose a file is by its content, whatever its name is. `by_name` is the format of files
  /// of that name; null: there is none.
  ContentOwner (*content_owner)(const std::filesystem::path& path,
                                const VolumeFormat* by_name) = nullptr;
  /// Returns whether a file that has one of the extensions is of another kind.
  bool (*refuses)(const std::filesystem::path& path) = nullptr;
  /// Returns whether a file whose name no format has is of this one.
  bool (*takes_unknown_name)(const std::filesystem::path& path) = nullptr;

  /// Reads a file's header. Throws Error.
  VolumeFile (*open)(const std::filesystem::path& path, const ReadOptions& options);
  /// Lists a file's arrays; null: the format gives them no names. Throws Error.
  std::vector<VolumeArray> (*list)(const std::filesystem::path& path,
                                   const ReadOptions& options) = nullptr;
  /// Opens a DICOM series without the files that turned out to be damaged. Throws Error.
  VolumeFile (*open_without)(const std::vector<DamagedDicomFile>& damaged,
                             const std::filesystem::path& path,
                             const ReadOptions& options) = nullptr;
  /// Returns the times of the steps, where opening without a time does not; null: it does. Throws
  /// Error.
  StepTimes (*times)(const std::filesystem::path& path, const ReadOptions& options) = nullptr;
  bool has_header = true;
  bool takes_axes = false;  ///< whether the options say which axes are x, y and z
  bool has_levels = false;  ///< of resolution
  bool has_times = false;   ///< whether a step is chosen by its time
  bool has_series = false;  ///< whether one of several series or images is chosen
  bool is_of_patients = false;
  bool is_json = false;  ///< whether its files are .json, as scenes are
};

/// Returns all formats of this build. CMake writes the source, from what the folders name.
std::span<const VolumeFormat* const> volume_formats();

/// Returns the format of files of this name; null: the name tells nothing.
const VolumeFormat* volume_format_by_name(std::string_view file_name);

/// Returns the format of a file or a folder, by its name and its content. Throws Error, with what
/// to do, where it is no volume that this build reads.
const VolumeFormat& find_volume_format(const std::filesystem::path& path,
                                       const ReadOptions& options);

/// Returns the times of a file's steps in its own order; empty: it has none. Reads no values.
/// Throws Error as read_volume() does.
StepTimes volume_times(const std::filesystem::path& path, const ReadOptions& options);

/// Headerless data, of any name whose dimensions and type are given.
extern const VolumeFormat raw_format;

}  // namespace pellucid
