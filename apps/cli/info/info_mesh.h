// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/io/mesh_source.h"

namespace pellucid::cli {

/// Prints what is in a mesh file and what its cells are as tetrahedra. Throws Error.
void print_mesh_info(const MeshSource& source, bool json);

}  // namespace pellucid::cli
