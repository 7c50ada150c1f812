// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

namespace pellucid {

/// Returns the bytes of a file of VTK's and of the files that it names. Throws Error, with the
/// file's name, where one is no regular file or a file of XML is cut off.
std::uintmax_t bytes_of_vtk_files(const std::filesystem::path& path);

/// Said where the process that calls VTK does not come to its end.
inline constexpr const char* vtk_fails =
    "VTK fails on it, or takes far more memory or time than its size lets expect; it is damaged";

}  // namespace pellucid
