// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vtkSmartPointer.h>
#include <vtkType.h>
#include <vtkUnsignedCharArray.h>

#include <array>
#include <vector>

class vtkDataSet;

namespace pellucid::plugin {

/// Flags of the ghosts at points and of cells, null if there are none, and when they changed last.
struct GhostTimes {
  std::array<vtkSmartPointer<vtkUnsignedCharArray>, 2> flags;
  std::array<vtkMTimeType, 2> times{};

  bool operator==(const GhostTimes&) const = default;
};
GhostTimes ghost_times(vtkDataSet& data);

/// Returns which values of an image or a rectilinear grid are hidden (vtkGhostType: HIDDENPOINT,
/// HIDDENCELL, REFINEDCELL); empty if none is. A cell is hidden with one of its points, and a value
/// at a point with all of its cells. Throws Error if a cell is hidden between cells that are not,
/// so that none of its points is hidden: values at points cannot show that.
std::vector<bool> hidden_places(vtkDataSet& data, bool of_cells);

}  // namespace pellucid::plugin
