// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "notes.h"
#include "pellucid/scene/scene.h"
#include "settings.h"

namespace pellucid::vtk_scene {

/// A vtkCamera.
struct CameraSettings {
  Vec3<double> position{}, focal_point{}, up{};
  Vec3<double> direction{};  ///< direction of the projection, of length 1
  bool is_parallel = false;  ///< ParallelProjection, whatever the matrix says
  double aspect = 1;         ///< width / height of the window's part
  Matrix projection{};       ///< GetProjectionTransformMatrix(aspect, -1, 1)
  std::array<double, 2> shear{};
  bool is_off_axis = false;
  bool has_view_transform = false;  ///< UserViewTransform or UserTransform
  std::optional<Matrix> model{};    ///< ModelTransformMatrix
};

/// A vtkRenderer and its part of a window.
struct ViewSettings {
  CameraSettings camera;
  int width = 0, height = 0;
  std::array<double, 2> pixel_aspect{1, 1};
  bool is_stereo = false, peels_volumes = false;
};

/// A vtkLight that is on.
struct LightSettings {
  bool is_head = false, is_positional = false;
  Vec3<double> position{}, focal_point{};  ///< in the world
  Rgb<double> color{1, 1, 1}, ambient{};
  double intensity = 1;
  std::array<double, 3> attenuation{1, 0, 0};
  double cone_angle = 180;
};

/// The lights of a vtkRenderer.
struct RendererLights {
  std::vector<LightSettings> shining{};
  bool are_two_sided = true, are_automatic = true;  ///< TwoSidedLighting, AutomaticLightCreation
};

/// Positions of a window buffer's depths along the view direction.
struct Depths {
  double near = 0, far = 0;  ///< distances of depth 0 and depth 1; far may be infinite
  bool is_parallel = false;

  /// Returns how far a depth from 0 to 1 is from the camera, along the view direction.
  double along_view(double depth) const noexcept;
};

/// Part of a scene's picture that a renderer's part of the window shows.
struct View {
  Camera camera;
  Depths depths;
  ImageSize size;             ///< pixels of the scene's picture
  int width = 0, height = 0;  ///< pixels of the window's part
  int column = 0, row = 0;    ///< place of the window's upper left pixel in the scene's picture

  /// Returns whether the picture is larger than the window's part.
  bool is_cut() const noexcept { return size.width != width || size.height != height; }
};

/// Returns the camera of a renderer, also of an explicit projection. A window of the camera that is
/// not in its middle, as of tiles, is a part of a larger picture, which has whole pixels. Throws
/// Error for what has no counterpart: shear, a transform of the view, pixels that are not square.
View view_of(const ViewSettings& settings, Notes& notes);
/// Returns the lights that are on. A renderer without lights has a head light, as VTK makes one.
/// `is_lit`: whether anything is seen in them.
std::vector<Light> lights_of(const RendererLights& lights, const CameraSettings& camera,
                             bool is_lit, Notes& notes);
/// Returns whether a property's ambient part is seen. VTK gives its color to it under one head
/// light of intensity 1; under other lights it has the lights' own ambient colors, which are black
/// unless a program sets them.
bool has_ambient_light(const RendererLights& lights);

/// Returns the camera's planes that cut a box off, of the two that VTK draws between. `bounds`:
/// xmin, xmax, ymin, ... in the world.
std::vector<Clip> depth_clips(const View& view, const std::array<double, 6>& bounds);

}  // namespace pellucid::vtk_scene
