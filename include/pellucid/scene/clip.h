// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "pellucid/geometry/box.h"
#include "pellucid/geometry/vec3.h"

namespace pellucid {

/// A half-space: the side of a plane that its normal points to. World coordinates.
struct ClipPlane {
  Vec3<double> point{};
  Vec3<double> normal{0, 0, 1};  ///< any length but 0
};
/// A box along the world's axes.
struct ClipBox {
  Vec3<double> lower{}, upper{1, 1, 1};
};
/// A ball.
struct ClipSphere {
  Vec3<double> center{};
  double radius = 1;
};
/// A cylinder with flat ends at `start` and `end`.
struct ClipCylinder {
  Vec3<double> start{}, end{0, 0, 1};
  double radius = 1;
};

/// A shape that limits where data are shown, in world coordinates. Its surface is exact: rays are
/// cut where they meet it.
struct Clip {
  std::variant<ClipPlane, ClipBox, ClipSphere, ClipCylinder> shape;
  bool keep_inside = true;  ///< false: cuts the shape away. A plane's inside is the kept side.
};

/// Throws Error if a number is not finite, a normal has no length, a radius is not positive, a box
/// is empty, or a cylinder has no length. `where` begins the message, e.g. "layer 2: clip 1".
void check_clip(const Clip& clip, const std::string& where);

}  // namespace pellucid
