// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/io/mesh_source.h"

namespace pellucid {

/// Loads a mesh as load_mesh() does. Of a file with steps in time, tetrahedra of `before`, another
/// step loaded by this, are taken where points and cells are equal to the bit. It may be null.
LoadedMesh load_mesh_step(const MeshSource& source, const MeshChannels* before,
                          const ParallelFor& parallel);

}  // namespace pellucid
