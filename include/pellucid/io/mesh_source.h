// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "pellucid/io/read_mesh.h"
#include "pellucid/scene/tetrahedralize.h"

namespace pellucid {

/// A mesh as named in a scene; nothing has been read yet.
struct MeshSource {
  std::filesystem::path file;
  MeshReadOptions options;
  /// Arrays that become channels. Empty: default_array(), as the channel "value".
  std::vector<MeshArrayChoice> channels;
};

/// Parses "ARRAY", "ARRAY:C" (component C, from 0), or either after "NAME=". Without a name the
/// channel takes the array's name, followed by "_C" if there is a component. Throws Error.
MeshArrayChoice parse_mesh_array(std::string_view text);

/// Takes "a:0" for the array of this name where there is one, and not for component 0 of "a".
void prefer_whole_names(const std::vector<MeshArray>& arrays,
                        std::vector<MeshArrayChoice>& choices);

/// Returns the names of the channels.
std::vector<std::string> channel_names(const MeshSource& source);

/// Throws Error if there are more than eight channels, or a name is invalid or a duplicate.
void check_mesh_source(const MeshSource& source);

/// A mesh and the arrays that became its channels.
struct LoadedMesh {
  std::shared_ptr<const MeshChannels> mesh;
  std::vector<MeshArrayChoice> channels;  ///< those of the source, or the default array
};

/// Returns a message about overlapping cells: their number, the first of them, and the likely
/// cause. Returns an empty text if no cells overlap.
std::string overlap_note(const MeshStatistics& statistics);

/// Reads the file and cuts its cells into tetrahedra. Throws Error.
LoadedMesh load_mesh(const MeshSource& source, const ParallelFor& parallel = {});

}  // namespace pellucid
