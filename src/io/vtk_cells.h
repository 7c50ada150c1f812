// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "pellucid/scene/unstructured_grid.h"

namespace pellucid {

/// What a cell of a type of VTK's is to us.
struct VtkCellKind {
  std::optional<CellShape> shape;  ///< none: it is flat, and left out
  int points = 0;                  ///< where it has a shape
};

/// Throws Error, naming it, for a type that has a volume but no shape here, and for a number that
/// is no type.
VtkCellKind cell_kind(int vtk_type);

}  // namespace pellucid
