// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace pellucid {

/// Slices in a folder that belong together: of one SeriesInstanceUID, and of one size, orientation,
/// pixel spacing and kind of values. A series whose slices differ in these is several.
struct DicomSeries {
  std::string uid, description, modality;  ///< as the files say; may be empty
  int slices = 0;
  int columns = 0, rows = 0;
  std::string unreadable_reason;  ///< why its values are not read; empty: they are
};

/// Whether a path leads to DICOM: a file that begins like one, or a folder with such a file. Says
/// nothing of whether it can be read.
bool is_dicom(const std::filesystem::path& path);

/// The series of a folder, or of the folder around a file, by their number (SeriesNumber), then by
/// their UID: as ReadOptions::series counts them, from 1. Folders within are not looked into.
/// Files that cannot be read are left out, and `note` is told. Throws Error where `path` is one.
std::vector<DicomSeries> list_dicom_series(
    const std::filesystem::path& path, const std::function<void(const std::string&)>& note = {});

/// The unit of the values of the series that is chosen as by ReadOptions::series: "Gy" of a dose,
/// "HU" and others where the files name it; else empty. Throws Error like read_volume.
std::string dicom_unit(const std::filesystem::path& path,
                       const std::optional<std::string>& series = {});

}  // namespace pellucid
