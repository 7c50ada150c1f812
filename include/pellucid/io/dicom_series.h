// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace pellucid {

/// Slices in a folder that belong together: they share the SeriesInstanceUID, size, orientation,
/// pixel spacing and kind of values. A series whose slices differ in one of these is listed as
/// several.
struct DicomSeries {
  std::string uid, description, modality;  ///< from the files; may be empty
  int slices = 0;
  int columns = 0, rows = 0;
  std::string unreadable_reason;  ///< why its values cannot be read; empty: they can
};

/// Returns whether a path leads to DICOM: a file that begins like one, or a folder with such a
/// file. The file may still be unreadable.
bool is_dicom(const std::filesystem::path& path);

/// Returns the series of a folder, or of the folder around a file, sorted by SeriesNumber, then by
/// UID. ReadOptions::series counts them in this order from 1. Subfolders are not searched. Leaves
/// out unreadable files and passes a message about them to `note`. Throws Error if `path` is such a
/// file.
std::vector<DicomSeries> list_dicom_series(
    const std::filesystem::path& path, const std::function<void(const std::string&)>& note = {});

/// Returns the unit of the values of a series: "Gy" for a dose, "HU" and others if the files name
/// it, else an empty text. `series` is as in ReadOptions. Throws Error like read_volume().
std::string dicom_unit(const std::filesystem::path& path,
                       const std::optional<std::string>& series = {});

}  // namespace pellucid
