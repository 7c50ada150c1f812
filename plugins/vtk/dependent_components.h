// SPDX-License-Identifier: Apache-2.0
#pragma once

class vtkDataArray;
class vtkVolumeMapper;

namespace pellucid::plugin {

/// Throws Error for dependent components that VTK does not show, or that have no counterpart.
void refuse_dependent_components(vtkVolumeMapper& mapper, vtkDataArray& array, bool has_mask);
/// Returns the value of components of color that stands for 1. Throws Error for types of which none
/// does.
double largest_color_value(vtkDataArray& array);

}  // namespace pellucid::plugin
