// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/clip.h"

#include <cmath>

#include "message.h"
#include "pellucid/scene/error.h"

namespace pellucid {
namespace {

/// Checks one clip; messages begin with its place in the scene.
class ClipCheck {
 public:
  explicit ClipCheck(const std::string& where) : where_(where) {}

  void operator()(const ClipPlane& plane) const {
    finite(plane.point, "point");
    direction(plane.normal, "normal");
  }
  void operator()(const ClipBox& box) const {
    finite(box.lower, "lower");
    finite(box.upper, "upper");
    for (int a = 0; a < 3; ++a) {
      if (box.lower[a] < box.upper[a]) continue;
      fail("box from " + tuple(box.lower) + " to " + tuple(box.upper) +
           " is empty; upper must be larger than lower along each axis");
    }
  }
  void operator()(const ClipSphere& sphere) const {
    finite(sphere.center, "center");
    radius(sphere.radius);
  }
  void operator()(const ClipCylinder& cylinder) const {
    finite(cylinder.start, "start");
    finite(cylinder.end, "end");
    radius(cylinder.radius);
    direction(cylinder.end - cylinder.start, "end - start");
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw Error(where_ + ": " + what); }

  void finite(const Vec3<double>& v, const char* what) const {
    for (int a = 0; a < 3; ++a) {
      if (!std::isfinite(v[a])) {
        fail(std::string(what) + " is " + tuple(v) + ", but all three must be finite numbers");
      }
    }
  }
  void direction(const Vec3<double>& v, const char* what) const {
    finite(v, what);
    const double length = std::hypot(v.x, v.y, v.z);
    if (!(length > 0 && std::isfinite(length))) {
      fail(std::string(what) + " is " + tuple(v) + ", but must have a length");
    }
  }
  void radius(double radius) const {
    if (radius > 0 && std::isfinite(radius)) return;
    fail("radius is " + number(radius) + ", but must be a positive number");
  }

  const std::string& where_;
};

}  // namespace

void check_clip(const Clip& clip, const std::string& where) {
  std::visit(ClipCheck(where), clip.shape);
}

}  // namespace pellucid
