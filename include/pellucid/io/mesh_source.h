// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "pellucid/io/read_mesh.h"
#include "pellucid/scene/cut_cells.h"

namespace pellucid {

/// A mesh as a scene names it: nothing is read yet.
struct MeshSource {
  std::filesystem::path file;
  MeshReadOptions options;
  /// Arrays as channels. None: default_array(), as the channel "value".
  std::vector<MeshArrayChoice> channels;
};

/// "ARRAY", "ARRAY:C" (component C, from 0) or either behind "NAME=". Without a name the channel is
/// called after the array, "_C" behind it. Throws Error.
MeshArrayChoice parse_mesh_array(std::string_view text);

std::vector<std::string> channel_names(const MeshSource& source);

/// Throws Error where there are more than eight channels, or a name is none or stands twice.
void check_mesh_source(const MeshSource& source);

struct LoadedMesh {
  std::shared_ptr<const MeshChannels> mesh;
  std::vector<MeshArrayChoice> channels;  ///< those of the source, or the one that was taken
};

/// What to tell where cells are inverted or overlap: how many, the first of them, and the likely
/// cause; empty where none do.
std::string overlap_note(const MeshStatistics& statistics);

/// Reads the file and cuts its cells into tetrahedra. Throws Error.
LoadedMesh load_mesh(const MeshSource& source, const ParallelFor& parallel = {});

}  // namespace pellucid
