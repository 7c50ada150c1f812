// SPDX-License-Identifier: Apache-2.0
#include "camera_moves.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pellucid/scene/view_camera.h"

namespace pellucid::view {

void turn(Camera& camera, double x, double y) {
  const double drag = std::hypot(x, y);
  if (drag == 0) return;
  const CameraAxes axes = camera_axes(camera);
  // The camera turns the other way than the data that follow the mouse.
  const Vec3<double> axis = (axes.up * -x + axes.right * -y) * (1 / drag);
  const double angle = drag * std::numbers::pi;
  const Vec3<double> offset = camera.position - camera.focal_point;
  camera.position = camera.focal_point + rotated(offset, axis, angle);
  camera.up = rotated(axes.up, axis, angle);
}

void pan(Camera& camera, double x, double y) {
  const CameraAxes axes = camera_axes(camera);
  const double height = height_at_focal_point(camera);
  const Vec3<double> move = (axes.up * y - axes.right * x) * height;
  camera.position = camera.position + move;
  camera.focal_point = camera.focal_point + move;
}

void zoom(Camera& camera, double factor) {
  zoom_camera(camera, factor);
}

void roll(Camera& camera, double degrees) {
  const CameraAxes axes = camera_axes(camera);
  camera.up = rotated(axes.up, axes.forward, degrees * std::numbers::pi / 180);
}

void center(Camera& camera, const Vec3<double>& point) {
  const Vec3<double> move = point - camera.focal_point;
  camera.position = camera.position + move;
  camera.focal_point = camera.focal_point + move;
}

void set_projection(Camera& camera, Projection projection, double reach) {
  if (camera.projection == projection) return;
  const double height = height_at_focal_point(camera);
  const Vec3<double> forward = camera_axes(camera).forward;
  camera.projection = projection;
  if (projection == Projection::orthographic) {
    camera.parallel_scale = height / 2;
    const double distance = std::max(length(camera.focal_point - camera.position), reach);
    camera.position = camera.focal_point - forward * distance;
  } else {
    const double tangent = std::tan(camera.vertical_angle * std::numbers::pi / 360);
    camera.position = camera.focal_point - forward * (height / 2 / tangent);
  }
}

double height_at_focal_point(const Camera& camera) {
  if (camera.projection == Projection::orthographic) return 2 * camera.parallel_scale;
  const double distance = length(camera.focal_point - camera.position);
  return 2 * distance * std::tan(camera.vertical_angle * std::numbers::pi / 360);
}

}  // namespace pellucid::view
