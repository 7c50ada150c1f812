// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "mesh_blocks.h"

namespace pellucid {

/// The formats that VTK reads.
enum class VtkFormat { xml, legacy, exodus };

/// What the module makes of a file: the mesh, or what went wrong, without the file's name. No
/// exception leaves it.
struct VtkAnswer {
  MeshBlocks mesh;
  std::string error;  ///< empty: none
};

/// The module's one function, by this name.
using ReadWithVtk = void(const std::filesystem::path& path, VtkFormat format,
                         const MeshReadOptions& options, VtkAnswer& answer);
inline constexpr const char* read_with_vtk_name = "pellucid_read_with_vtk_1";

/// The function of the module, loaded by the first call and kept: VTK's libraries, and those that
/// they need in turn, would otherwise double the time that every start of a program takes. Looked
/// for in the folder that the environment variable PELLUCID_MODULES names, then where an
/// installation has it as seen from the program, then where this library was to be installed.
/// Throws Error where the build has none or it does not load.
ReadWithVtk& vtk_module();

}  // namespace pellucid
