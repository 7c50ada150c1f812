// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/view_camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pellucid/scene/defaults.h"

namespace pellucid {

namespace {

struct View {
  std::string_view name;
  Vec3<double> forward, up;
};

// x grows towards left, y towards posterior, z towards superior.
constexpr View views[] = {
    {"front", {0, 1, 0}, {0, 0, 1}}, {"back", {0, -1, 0}, {0, 0, 1}},
    {"left", {-1, 0, 0}, {0, 0, 1}}, {"right", {1, 0, 0}, {0, 0, 1}},
    {"top", {0, 0, -1}, {0, -1, 0}}, {"bottom", {0, 0, 1}, {0, -1, 0}},
};

}  // namespace

const std::vector<std::string>& view_names() {
  static const std::vector<std::string> names = {"front", "back",   "left",   "right",
                                                 "top",   "bottom", "oblique"};
  return names;
}

Camera view_camera(const std::array<Vec3<double>, 8>& corners, std::string_view name,
                   ImageSize size) {
  const auto view = std::find_if(std::begin(views), std::end(views),
                                 [&](const View& v) { return v.name == name; });
  if (view == std::end(views)) return default_camera(corners, size);
  return camera_along(view->forward, view->up, corners, size);
}

Camera camera_along(const Vec3<double>& forward, const Vec3<double>& up,
                    const std::array<Vec3<double>, 8>& corners, ImageSize size) {
  Vec3<double> center{0, 0, 0};
  for (const Vec3<double>& corner : corners) center = center + corner * 0.125;

  Camera camera;
  camera.focal_point = center;
  camera.up = up;
  const double tangent = std::tan(camera.vertical_angle * std::numbers::pi / 360);
  const double aspect = static_cast<double>(size.width) / static_cast<double>(size.height);
  const Vec3<double> right = cross(forward, up);
  // The nearest distance at which every corner of the box is inside of the image.
  double distance = 0;
  for (const Vec3<double>& corner : corners) {
    const Vec3<double> offset = corner - center;
    const double half_height =
        std::max(std::abs(dot(offset, up)), std::abs(dot(offset, right)) / aspect);
    distance = std::max(distance, half_height / tangent - dot(offset, forward));
  }
  constexpr double margin = 1.03;
  camera.position = center - forward * (distance * margin);
  return camera;
}

Vec3<double> rotated(const Vec3<double>& v, const Vec3<double>& axis, double radians) noexcept {
  const double cosine = std::cos(radians), sine = std::sin(radians);
  return v * cosine + cross(axis, v) * sine + axis * (dot(axis, v) * (1 - cosine));
}

void turn_camera(Camera& camera, double azimuth, double elevation) {
  constexpr double degree = std::numbers::pi / 180;
  make_camera_frame(camera, {1, 1});
  const Vec3<double> up = normalized(camera.up);
  Vec3<double> offset = rotated(camera.position - camera.focal_point, up, azimuth * degree);
  if (elevation != 0) {
    const Vec3<double> right = normalized(cross(up, offset));
    offset = rotated(offset, right, -elevation * degree);
    camera.up = normalized(cross(offset, right));
  }
  camera.position = camera.focal_point + offset;
}

void zoom_camera(Camera& camera, double factor) noexcept {
  if (camera.projection == Projection::orthographic) {
    camera.parallel_scale /= factor;
  } else {
    camera.position = camera.focal_point + (camera.position - camera.focal_point) * (1 / factor);
  }
}

}  // namespace pellucid
