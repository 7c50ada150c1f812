// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/geometry/affine.h"
#include "pellucid/scene/clip.h"

class vtkDataSet;

namespace pellucid::plugin {

/// Returns the planes around the cells of an image or a rectilinear grid that are its own, in the
/// world. The ghost cells outside of them (vtkGhostType: DUPLICATECELL) are another block's or
/// another process's; they are there for values and gradients at the border. Throws Error if the
/// cells that are no ghosts do not fill a box.
std::vector<Clip> clips_at_ghosts(vtkDataSet& data, const Affine<double>& world_from_data);

/// Returns whether all cells of such a grid are ghosts.
bool is_all_ghosts(vtkDataSet& data);

}  // namespace pellucid::plugin
