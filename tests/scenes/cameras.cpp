// SPDX-License-Identifier: Apache-2.0
#include "tests/scenes/cameras.h"

namespace pellucid::scenes {

std::vector<NamedCamera> three_cameras(const Volume& volume) {
  const auto corners = volume.world_corners();
  Vec3<double> centre{};
  for (const Vec3<double>& corner : corners) centre = centre + corner * 0.125;
  double radius = 0;
  for (const Vec3<double>& corner : corners) radius = std::max(radius, length(corner - centre));

  const Vec3<double> lower = volume.grid_lower(), extent = volume.grid_upper() - lower;
  const auto inside = [&](const Vec3<double>& share) {
    const Vec3<double> position{lower.x + share.x * extent.x, lower.y + share.y * extent.y,
                                lower.z + share.z * extent.z};
    return volume.world_from_grid().point(position);
  };
  const Vec3<double> oblique{-0.5, -0.7, -1};
  return {{"parallel", parallel_camera(centre - oblique * (2 * radius), oblique, 0.7 * radius)},
          {"perspective", perspective_camera(centre + Vec3<double>{1.9, -2.3, 1.1} * radius, centre,
                                             28, {0, 0, 1})},
          {"inside", perspective_camera(inside({0.55, 0.47, 0.61}), inside({0.13, 0.72, 0.24}), 85,
                                        {0.2, 1, 0.1})}};
}

Camera parallel_camera(const Vec3<double>& position, const Vec3<double>& direction,
                       double parallel_scale, const Vec3<double>& up) {
  Camera camera;
  camera.projection = Projection::orthographic;
  camera.position = position;
  camera.focal_point = position + direction;
  camera.up = up;
  camera.parallel_scale = parallel_scale;
  return camera;
}

Camera perspective_camera(const Vec3<double>& position, const Vec3<double>& focal_point,
                          double vertical_angle, const Vec3<double>& up) {
  Camera camera;
  camera.position = position;
  camera.focal_point = focal_point;
  camera.up = up;
  camera.vertical_angle = vertical_angle;
  return camera;
}

double scale_of_pixels(int size, double distance) {
  return size * distance;
}

}  // namespace pellucid::scenes
