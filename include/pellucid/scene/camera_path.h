// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "pellucid/scene/scene.h"

namespace pellucid {

/// Returns a camera that has moved around its focal point by an angle, its upward direction with
/// it: around `axis`, or without one around that direction. From a positive angle the scene turns
/// clockwise as seen against the axis. Throws Error if the axis has no length.
Camera turned_camera(const Camera& camera, double degrees,
                     const std::optional<Vec3<double>>& axis = {});

/// A camera that a path goes through.
struct CameraKey {
  Camera camera;
  std::optional<double> at;  ///< seconds; none: at the path's constant speed
};

/// A smooth way through cameras: it passes through each of them, and its velocity has no jumps.
/// The eye keeps its distance from what it looks at: turns are interpolated as turns, distances and
/// angles of view by their logarithms, and focal points as they are, each by the splines of Catmull
/// and Rom as Barry and Goldman (1988) evaluate them, for turns on the sphere (Shoemake 1985). So
/// four cameras around an object make a circle, which does not cut through it.
class CameraPath {
 public:
  /// Makes the way through `keys`, at least one. With times the path is at each key when it says,
  /// and between two its way is a monotone cubic of the time; without, its speed is constant over
  /// `seconds`, where equal cameras that follow each other count as one. `is_closed`: after the
  /// last key it returns to the first, at `seconds`. Throws Error if there is no key, if some keys
  /// have times and others have none, if times do not ascend from 0 to `seconds`, if a camera is
  /// not valid, or if their projections differ.
  CameraPath(const std::vector<CameraKey>& keys, double seconds, bool is_closed = false);

  /// Returns the camera at a moment; before the first key it is the first, after the last the last.
  Camera at(double seconds) const;

 private:
  /// A camera in parts that can be interpolated.
  struct View {
    std::array<double, 4> turn{};     ///< a quaternion of length 1, its real part last
    std::array<double, 3> focus{};    ///< the focal point
    std::array<double, 2> lengths{};  ///< logarithms of the distance and of the angle or the scale
  };

  static View view_of(const Camera& camera);
  static View mixed(const View& a, const View& b, double share);
  static double distance_between(const View& a, const View& b);
  View view_at(double knot) const;
  Camera camera_of(const View& view) const;
  std::vector<double> measure();
  void find_speeds();
  double way_at(double seconds) const;

  Camera like_;  ///< has the projection of all
  // With one key more than was given at either end, to bend the ends by.
  std::vector<View> views_;
  std::vector<double> knots_;
  std::vector<double> lengths_, places_;       // how far it is to which knot
  std::vector<double> times_, ways_, speeds_;  // how far the path is at which time, and how fast
};

}  // namespace pellucid
