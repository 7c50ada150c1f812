// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace pellucid {

/// VTK cuts whole numbers in the text of legacy files to the bits of their type, 300 to 44. Throws
/// Error where an array has such a number. Files in binary have none.
void check_legacy_vtk_numbers(const std::filesystem::path& path);
/// The same of a file in memory, whose name begins the message.
void check_legacy_vtk_numbers(std::string_view text, const std::string& name);

}  // namespace pellucid
