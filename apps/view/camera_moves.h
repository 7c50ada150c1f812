// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "pellucid/scene/scene.h"

namespace pellucid::view {

// How a drag moves the camera. Distances on the picture are fractions of its height, x to the right
// and y downwards.

/// Turns the camera around its focal point, as if the data were a ball under the mouse: a drag
/// along the whole height is half a turn.
void turn(Camera& camera, double x, double y);
/// Moves camera and focal point so that what is at the focal point follows the mouse.
void pan(Camera& camera, double x, double y);
/// Enlarges the picture by a factor: the camera comes closer, or the parallel scale shrinks.
void zoom(Camera& camera, double factor);
/// Turns the picture counterclockwise.
void roll(Camera& camera, double degrees);
/// Moves camera and focal point so that the focal point is at `point`.
void center(Camera& camera, const Vec3<double>& point);
/// Changes the kind of projection; what is at the focal point keeps its size. Orthographic rays
/// start in a plane through the camera, so that it is moved back to `reach` from the focal point.
void set_projection(Camera& camera, Projection projection, double reach);

/// Returns the height of the picture at the focal point, in world units.
double height_at_focal_point(const Camera& camera);

}  // namespace pellucid::view
