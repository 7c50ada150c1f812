// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pellucid {

/// A file's name around the last digits before its extension: "ct-16bit", "007", ".tif".
struct NumberedName {
  std::string before, digits, behind;
};
/// Nothing where there are no digits, or more than a number can hold.
std::optional<NumberedName> numbered_name(const std::string& name);

/// Files in the order of their numbers. Throws Error where one number stands twice, or they do not
/// go up in equal steps.
std::vector<std::filesystem::path> in_order(const std::vector<std::filesystem::path>& files,
                                            const std::string& name);

/// The pattern of a name, "ct%03d.tif": what stands around the number, and how it is written.
struct NamePattern {
  std::string before, behind;
  std::size_t width = 0;
  bool zeros = false;
  /// Whether printf writes this name.
  bool matches(const std::string& name) const;
};
/// Nothing where there is not exactly one of %d, %3d, %03d.
std::optional<NamePattern> name_pattern(const std::string& text);

/// The files of a folder whose names satisfy, by name; `others` is how many do not. Throws Error.
std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder,
                                            const std::function<bool(const std::string&)>& wanted,
                                            std::size_t* others = nullptr);

}  // namespace pellucid
