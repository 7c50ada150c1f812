// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pellucid/scene/scene.h"

namespace pellucid::scenes {

struct NamedCamera {
  std::string name;
  Camera camera;
};

/// Parallel and oblique, perspective from outside, and from within: for any placement of the grid.
std::vector<NamedCamera> three_cameras(const Volume& volume);
/// The same for what is in the box.
std::vector<NamedCamera> three_cameras(const Box<double>& box);

/// Parallel, from `position` along `direction`.
Camera parallel_camera(const Vec3<double>& position, const Vec3<double>& direction,
                       double parallel_scale, const Vec3<double>& up = {0, 1, 0});
/// Perspective, from `position` to `focal_point`.
Camera perspective_camera(const Vec3<double>& position, const Vec3<double>& focal_point,
                          double vertical_angle, const Vec3<double>& up = {0, 1, 0});

/// Of parallel_camera, such that the centres of size × size pixels lie at odd multiples of
/// `distance`.
double scale_of_pixels(int size, double distance);

}  // namespace pellucid::scenes
