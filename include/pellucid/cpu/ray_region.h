// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "pellucid/geometry/ray.h"

namespace pellucid {

/// A convex part of the world to which a frame keeps (RenderOptions::region): the intersection of
/// half-spaces. Frames of regions that partition the world are the parts of one frame: a ray is cut
/// at the same positions in all of them, and each position belongs to one.
struct RayRegion {
  /// A half-space: dot(normal, x) >= offset if `above`, and < offset if not. World coordinates.
  struct HalfSpace {
    Vec3<double> normal;
    double offset = 0;
    bool above = true;
  };
  std::vector<HalfSpace> half_spaces;
  /// Corners of the region within the data, if it is a box there: bit a of the index tells the side
  /// along axis a. Without them no pixel is interpolated between rays.
  std::optional<std::array<Vec3<double>, 8>> corners{};
  /// Returns how many times the scene's tolerance a ray may be off by: more than 1 where fewer
  /// other regions share it than the tolerance allows for, less where more do. If it is empty, 1.
  /// Where pixels are interpolated between rays, no ray has more than 1. Called by any thread.
  std::function<double(const Ray<double>&)> allowance{};

  /// Returns the range of the ray in the region, world arc length; empty or of no length if the ray
  /// passes it by. The position on a plane depends on nothing but the plane and the ray: two
  /// regions beside each other end and begin at the same bits.
  Interval<double> range(const Ray<double>& ray) const noexcept;
};

}  // namespace pellucid
