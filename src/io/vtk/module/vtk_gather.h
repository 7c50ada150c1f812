// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meshes/mesh_blocks.h"

class vtkDataObject;

namespace pellucid {

/// Copies the cells, points and arrays of VTK's unstructured and structured grids, and of all in a
/// collection of them, to `mesh`. Surfaces among others are counted as flat cells. Throws Error
/// for what is neither, for cells as cell_kind() does, and where sizes or indices are wrong.
void gather(vtkDataObject& object, MeshBlocks& mesh);

}  // namespace pellucid
