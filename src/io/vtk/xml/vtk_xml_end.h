// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <set>

namespace pellucid {

/// Throws Error where a file of VTK's XML, or one that it names as a part of itself, does not end
/// as it should: VTK gives what memory holds for appended values that are cut off. What is no such
/// file, or not there, VTK refuses itself. Returns the files: itself and its parts.
std::set<std::filesystem::path> check_vtk_xml_end(const std::filesystem::path& path);

}  // namespace pellucid
