// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "grid_layers.h"

namespace pellucid::vtk_scene {

/// Throws Error for dependent components that VTK does not show, or that have no counterpart.
void refuse_dependent_components(const GridVolume& volume);
/// Returns the value of components of color that stands for 1. Throws Error for types of which none
/// does.
double largest_color_value(const GridData& data);

}  // namespace pellucid::vtk_scene
