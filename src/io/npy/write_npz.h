// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pellucid/scene/mesh_channels.h"
#include "volumes/volume_writers.h"

namespace pellucid {

/// The array that names the space of the world, in letters (world_space()).
inline constexpr const char* npz_space = "space";

/// Writes an archive of numpy with the components of a volume as one array, and beside it where it
/// is (VolumeWriter::write).
Losses write_npz(const WrittenVolume& volume, const Sink& sink);
/// Tells whether a matrix says where its values are, and its axes are x, y and z; else positions
/// along z, y and x do.
bool has_npz_matrix(const Volume::Description& description);
/// Writes one with a mesh: "points", "tetrahedra", and an array for each channel. Returns the names
/// of these.
std::vector<std::string> write_mesh_npz(const MeshChannels& mesh, const Sink& sink);

}  // namespace pellucid
