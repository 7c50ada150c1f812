// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "pellucid/scene/scene.h"

namespace pellucid {

/// Returns the names of the views along the axes of an LPS world, and "oblique".
const std::vector<std::string>& view_names();

/// Returns a perspective camera on the named side of a box (world_corners) that just holds it, with
/// 3 % to spare. In a world of LPS, "front" looks at a face, "left" at the patient's left side, and
/// "top" and "bottom" have the face up. "oblique" is default_camera(). The name is one of
/// view_names().
Camera view_camera(const std::array<Vec3<double>, 8>& corners, std::string_view name,
                   ImageSize size);

/// Returns a perspective camera that looks along `forward`, with `up` upwards, both of length 1 and
/// at right angles, and just holds a box (world_corners) with 3 % to spare.
Camera camera_along(const Vec3<double>& forward, const Vec3<double>& up,
                    const std::array<Vec3<double>, 8>& corners, ImageSize size);

/// Turns a camera around its focal point, by degrees: `azimuth` moves it to the right around its
/// upward direction, `elevation` moves it up and takes that direction along, as VTK's cameras do.
/// Throws Error if the camera has no view direction, or looks along its `up`.
void turn_camera(Camera& camera, double azimuth, double elevation);
/// Enlarges the picture by a factor above 0: the camera comes closer to its focal point, or its
/// parallel scale shrinks.
void zoom_camera(Camera& camera, double factor) noexcept;
/// Returns `v` turned by an angle around an axis of length 1, by Rodrigues' formula.
Vec3<double> rotated(const Vec3<double>& v, const Vec3<double>& axis, double radians) noexcept;

}  // namespace pellucid
