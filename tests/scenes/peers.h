// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tests/scenes/makers.h"

/// Scenes on which other renderers were measured, and scenes made to break one. Volumes live on
/// [-1,1]³ unless said; `points` is the number of data values per axis.
namespace pellucid::scenes {

struct NamedScene {
  std::string name;
  Scene scene;
};

/// Parallel views of [-1,1]²: oblique looks along (-0.5, -0.7, -1), axis along -z, diagonal along
/// (-1, -1, -1).
enum class View { oblique, axis, diagonal };
const char* view_name(View view);
Camera view_camera(View view, double parallel_scale = 1);

/// Extinction 0.5 + v; color (v, ½ + ½cos 7v, 1 − v) tabulated linearly at 256 points.
TransferPointer haze_transfer();
/// Extinction peak · max(0, 1 − |v − 0.5|/half_width), the color of haze.
TransferPointer peak_transfer(double peak, double half_width);
TransferPointer band_transfer();   ///< peak 20, half width 0.05
TransferPointer spike_transfer();  ///< peak 100, half width 0.012
TransferPointer comb_transfer();   ///< 256 control points, each of which is a corner

/// Haze, band and spike in the Marschner-Lobb field, each from the three views.
std::vector<NamedScene> marschner_lobb_scenes(int points, ImageSize size);

/// Weiß and Westermann's "scene2": Marschner-Lobb in a box of side 1, two thin and one broad peak.
/// `upper` is where their sweep ends the range of the control points: .74 as published, down to
/// .36.
TransferPointer ray_splitting_transfer(double upper = .74);
NamedScene ray_splitting_scene(int points, ImageSize size, double upper = .74);

/// A sphere 1 − r behind a peak .5 ± .002 of extinction 375, from an odd number of pixels: along an
/// axis, along the body diagonal, and from a perspective camera inside.
std::vector<NamedScene> sphere_scenes(int points, ImageSize size);

/// Where traversal and thin cases break: data that is constant along the ray (f(x,y) along z), a
/// constant field, a camera inside, rays that run in grid planes, coarse and anisotropic grids,
/// cell-centred data, a jump.
std::vector<NamedScene> torture_scenes(int points, ImageSize size);

}  // namespace pellucid::scenes
