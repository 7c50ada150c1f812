// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/scene/image.h"

class vtkRenderer;

namespace pellucid::plugin {

/// Returns whether a renderer draws a pass of a selection, by which pickers find props: its colors
/// are numbers of what is selected.
bool is_selecting(vtkRenderer& renderer);
/// Returns whether a volume is drawn in that pass: if props alone are looked for, as vtkPropPicker
/// does. It has a number as a prop, and none of points or cells.
bool is_selected_by_prop(vtkRenderer& renderer);
/// Replaces a picture by the number of the prop that is drawn, where a window of 8 bits shows the
/// volume, and by nothing elsewhere.
void show_number_of_prop(vtkRenderer& renderer, Image& image);

}  // namespace pellucid::plugin
