// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "settings.h"
#include "vtk_scene/view.h"

class vtkRenderer;

namespace pellucid::plugin {

/// A view with its place in the window.
struct WindowView : View {
  int left = 0, bottom = 0;  ///< corner of the renderer's part in the window
};

/// Returns the camera of a renderer, as vtk_scene::view_of(). Throws Error.
WindowView view_of(vtkRenderer& renderer, Notes& notes);
/// Return the lights of a renderer, and whether a property's ambient part is seen, as the functions
/// of vtk_scene of these names.
std::vector<Light> lights_of(vtkRenderer& renderer, bool is_lit, Notes& notes);
bool has_ambient_light(vtkRenderer& renderer);

/// Returns where rays end because of what is in the window already: a clear picture with the
/// distances of its depth buffer. Outside of the window's part rays end at once. Null: nothing is
/// there, and the picture is not cut. Throws Error if the window has no depths.
std::shared_ptr<const Image> geometry_of(vtkRenderer& renderer, const WindowView& view);

}  // namespace pellucid::plugin
