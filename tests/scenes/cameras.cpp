// SPDX-License-Identifier: Apache-2.0
#include "tests/scenes/cameras.h"

namespace pellucid::scenes {

namespace {

/// `inside`: the place at a share of the way along each axis.
template <class Inside>
std::vector<NamedCamera> three_cameras(const Vec3<double>& centre, double radius,
                                       const Inside& inside) {
  const Vec3<double> oblique{-0.5, -0.7, -1};
  return {{"parallel", parallel_camera(centre - oblique * (2 * radius), oblique, 0.7 * radius)},
          {"perspective", perspective_camera(centre + Vec3<double>{1.9, -2.3, 1.1} * radius, centre,
                                             28, {0, 0, 1})},
          {"inside", perspective_camera(inside({0.55, 0.47, 0.61}), inside({0.13, 0.72, 0.24}), 85,
                                        {0.2, 1, 0.1})}};
}

Vec3<double> place_in(const Box<double>& box, const Vec3<double>& share) {
  const Vec3<double> extent = box.upper - box.lower;
  return box.lower + Vec3<double>{share.x * extent.x, share.y * extent.y, share.z * extent.z};
}

}  // namespace

std::vector<NamedCamera> three_cameras(const Volume& volume) {
  const auto corners = volume.world_corners();
  Vec3<double> centre{};
  for (const Vec3<double>& corner : corners) centre = centre + corner * 0.125;
  double radius = 0;
  for (const Vec3<double>& corner : corners) radius = std::max(radius, length(corner - centre));
  const Box<double> grid{volume.grid_lower(), volume.grid_upper()};
  return three_cameras(centre, radius, [&](const Vec3<double>& share) {
    return volume.world_from_grid().point(place_in(grid, share));
  });
}

std::vector<NamedCamera> three_cameras(const Box<double>& box) {
  return three_cameras(0.5 * (box.lower + box.upper), 0.5 * length(box.upper - box.lower),
                       [&](const Vec3<double>& share) { return place_in(box, share); });
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
