// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "mesh_blocks.h"
#include "pellucid/io/read_mesh.h"

namespace pellucid {

/// A format of mesh files: its name, how its files are told from others, and how they are read.
/// Folders of formats define such objects and name them in their sources.cmake, as of VolumeFormat.
struct MeshFormat {
  std::string_view name = {};        ///< for people
  std::string_view extensions = {};  ///< of files' names, in small letters: ".xyz .p3d"
  /// Returns whether a file is of this format by its content, whatever its name is. `head` are its
  /// first 64 KiB. Null: its content does not tell.
  bool (*takes_content)(const std::filesystem::path& path, std::string_view head) = nullptr;
  bool content_decides = false;  ///< whether an extension tells nothing of a file that is there
  /// Reads a file, of which is known that it is there. Throws Error.
  MeshBlocks (*read)(const std::filesystem::path& path, const MeshReadOptions& options);
  /// Returns the times of the steps, in any order; null: the format has none. Throws Error.
  std::vector<double> (*times)(const std::filesystem::path& path) = nullptr;
  bool takes_solution = false;  ///< in a file of its own: MeshReadOptions::q
};

/// Returns all formats of this build. CMake writes the source, from what the folders name. No two
/// take the content of the same file, but for files of HDF5, of which VTKHDF is asked first.
std::span<const MeshFormat* const> mesh_formats();

/// Returns the times of a file's steps; empty: it has none. Throws Error as read_mesh() does.
std::vector<double> mesh_times(const std::filesystem::path& path, const MeshReadOptions& options);

}  // namespace pellucid
