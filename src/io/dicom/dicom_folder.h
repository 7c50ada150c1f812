// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dicom_slices.h"
#include "pellucid/io/dicom_series.h"

namespace pellucid {

struct DicomGroup {
  DicomSeries about;
  std::vector<DicomSlice> slices;  ///< in the order of the files' names
  std::vector<std::string> notes;  ///< what is assumed of them together, a line each
};

struct DicomFolder {
  std::vector<DicomGroup> series;
  std::size_t others = 0;                 ///< files that hold no slice
  std::vector<DamagedDicomFile> damaged;  ///< left out, in the order of their names
};

/// Returns the files of a folder, or of the one around a file. Those that cannot be read are left
/// out, and those of `known` too. Throws Error where `path` itself is one of them.
DicomFolder scan_dicom_folder(const std::filesystem::path& path,
                              const std::vector<DamagedDicomFile>& known = {});

/// Returns "3 files are left out; the first: ..."; empty where none is.
std::string left_out_text(const std::vector<DamagedDicomFile>& files);

/// Returns the series that is wanted: its number from 1, its UID or the unique end of it; where
/// none is, the only one, or for a file its own. Throws Error, listing what there is.
DicomGroup choose_dicom_series(const DicomFolder& folder, const std::filesystem::path& path,
                               const std::optional<std::string>& wanted);

}  // namespace pellucid
