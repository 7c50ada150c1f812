// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "files/numbered_files.h"

namespace pellucid {

/// Files whose names differ by one number.
struct NameSeries {
  std::string pattern;  ///< that name_pattern() reads, or the one name
  std::vector<NumberedFile> files;
};

/// Sorts files into series, each in at least one, by their names alone. A hyphen is a sign where
/// some numbers have it and some do not. Numbers have decimals where their whole parts differ, too.
/// Names that differ by several numbers at once ("S_z00_ch01.tif") make a series for each choice of
/// the others, unless the numbers go up together.
std::vector<NameSeries> name_series(const std::vector<std::filesystem::path>& files);

/// Returns the series that a file may be of: one, or several where more than one of its numbers
/// varies.
std::vector<NameSeries> name_series_of(const std::filesystem::path& file,
                                       const std::vector<std::filesystem::path>& files);

/// Returns "S_z%02d_ch00.tif (6 files), …" for messages.
std::string series_text(const std::vector<NameSeries>& series);

}  // namespace pellucid
