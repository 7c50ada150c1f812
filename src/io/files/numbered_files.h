// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pellucid {

/// A number of a file name: mantissa · 10^-fraction_digits.
struct NameNumber {
  std::int64_t mantissa = 0;
  int fraction_digits = 0;
};
/// Reads "007", "-3", "+3", "0.25"; nothing for other text and more than 15 digits.
std::optional<NameNumber> name_number(std::string_view text);

struct NumberedFile {
  NameNumber number;
  std::filesystem::path file;
};

/// Files in the order of their numbers. Throws Error where one number stands twice, or they do not
/// go up in equal steps. Decimals may be rounded.
std::vector<std::filesystem::path> in_order(const std::vector<NumberedFile>& files,
                                            const std::string& name);

/// The pattern of a name, "ct%03d.tif": the text around the number, and how it is written.
struct NamePattern {
  std::string before, behind;
  char letter = 'd';  ///< 'd', 'f' or 'g', as printf has them
  std::size_t width = 0;
  std::size_t precision = 6;
  bool zeros = false;
  bool plus = false;  ///< before numbers from 0
  /// Returns the number of a name that printf writes with this pattern; nothing for other names.
  std::optional<NameNumber> number(const std::string& name) const;
};
/// Reads a pattern with one of %d, %3d, %03d, %+d, %f, %.2f, %g; %% stands for %. `conversions` is
/// how many there are. Returns nothing unless there is one.
std::optional<NamePattern> name_pattern(const std::string& text,
                                        std::size_t* conversions = nullptr);

/// Returns the files of a folder whose names satisfy, by name; `others` is how many do not. Files
/// that macOS puts beside others (AppleDouble, "._x") are none of either. Throws Error.
std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder,
                                            const std::function<bool(const std::string&)>& wanted,
                                            std::size_t* others = nullptr);

}  // namespace pellucid
