// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "notes.h"
#include "pellucid/geometry/affine.h"
#include "pellucid/scene/scene.h"

class vtkMatrix4x4;
class vtkRenderer;

namespace pellucid::plugin {

/// Positions of a window buffer's depths along the view direction.
struct Depths {
  double near = 0, far = 0;  ///< of depth 0 and depth 1; far may be infinite
  bool is_parallel = false;

  /// Returns how far a depth from 0 to 1 is from the camera, along the view direction.
  double along_view(double depth) const noexcept;
};

/// Part of a scene's picture that a renderer's part of the window shows.
struct View {
  Camera camera;
  Depths depths;
  ImageSize size;             ///< of the scene's picture
  int width = 0, height = 0;  ///< of the window's part
  int column = 0, row = 0;    ///< of the window's upper left pixel in the scene's picture
  int left = 0, bottom = 0;   ///< of the renderer's part in the window

  /// Returns whether the picture is larger than the window's part.
  bool is_cut() const noexcept { return size.width != width || size.height != height; }
};

/// Returns the camera of a renderer, also of an explicit projection. A window of the camera that is
/// not in its middle, as of tiles, is a part of a larger picture, which has whole pixels. Throws
/// Error for what has no counterpart: shear, a transform of the view, pixels that are not square.
View view_of(vtkRenderer& renderer, Notes& notes);
/// Returns the lights that are on. A renderer without lights has a head light, as VTK makes one.
/// `is_lit`: whether anything is seen in them.
std::vector<Light> lights_of(vtkRenderer& renderer, bool is_lit, Notes& notes);
/// Returns whether a property's ambient part is seen. VTK gives its color to it under one head
/// light of intensity 1; under other lights it has the lights' own ambient colors, which are black
/// unless a program sets them.
bool has_ambient_light(vtkRenderer& renderer);
/// Returns an affine matrix of VTK. Throws Error for others. `what` begins the message.
Affine<double> affine_of(vtkMatrix4x4& matrix, const char* what);

/// Returns where rays end because of what is in the window already: a clear picture with the
/// distances of its depth buffer. Outside of the window's part rays end at once. Null: nothing is
/// there, and the picture is not cut. Throws Error if the window has no depths.
std::shared_ptr<const Image> geometry_of(vtkRenderer& renderer, const View& view);

/// Returns the camera's planes that cut a box off, of the two that VTK draws between. `bounds`:
/// xmin, xmax, ymin, ... in the world.
std::vector<Clip> depth_clips(const View& view, const double bounds[6]);

}  // namespace pellucid::plugin
