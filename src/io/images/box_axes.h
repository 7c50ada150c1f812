// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "cairo_module.h"
#include "pellucid/io/figure.h"

namespace pellucid {

/// Axes along edges of a box as seen, and its other edges that border on the background.
struct BoxAxes {
  std::vector<DrawnAxis> axes;
  std::vector<std::array<PagePoint, 2>> outline;
};

/// Returns at most one axis for each direction: of its edges in the silhouette of the box, behind
/// which nothing is seen, the one that is lowest or leftmost. Directions that are seen nearly end
/// on have none, nor has a box that the camera is in. `points_per_pixel`: scale of the picture, for
/// the distance of ticks.
BoxAxes box_axes(const FigureSpace& space, ImageSize size, double points_per_pixel);

/// Returns where a position is seen, in pixels; none: behind the camera.
std::optional<PagePoint> seen_at(const CameraFrame<double>& frame, const Vec3<double>& position);

/// Returns the largest of 1, 2 and 5 times a power of ten that is not above `most`, which is
/// positive.
double round_length(double most);

/// Returns the letters of the ends of an axis, the lower one first: "R" and "L", or "" and "x".
std::array<std::string, 2> axis_ends(int axis, bool is_anatomical);

}  // namespace pellucid
