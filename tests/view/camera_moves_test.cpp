// SPDX-License-Identifier: Apache-2.0
#include "view/camera_moves.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pellucid::view::camera_moves_test {
namespace {

void expect_near(const Vec3<double>& a, const Vec3<double>& b) {
  EXPECT_NEAR(length(a - b), 0, 1e-12) << a.x << ", " << a.y << ", " << a.z;
}

// At (0, 0, 2), looking at the origin, y upwards.
Camera camera_at_two() {
  Camera camera;
  camera.position = {0, 0, 2};
  return camera;
}

TEST(CameraMoves, TurningFollowsTheMouse) {
  Camera camera = camera_at_two();
  turn(camera, 0.5, 0);  // a quarter to the right: what was on the left is in front
  expect_near(camera.position, {-2, 0, 0});
  expect_near(camera.up, {0, 1, 0});
  camera = camera_at_two();
  turn(camera, 0, 0.5);  // downwards: what was above is in front
  expect_near(camera.position, {0, 2, 0});
  expect_near(camera.up, {0, 0, -1});
}

TEST(CameraMoves, TurningKeepsTheDistance) {
  Camera camera = camera_at_two();
  for (int i = 0; i < 1000; ++i) turn(camera, 0.013, -0.007);
  EXPECT_NEAR(length(camera.position - camera.focal_point), 2, 1e-9);
  EXPECT_NEAR(length(camera.up), 1, 1e-9);
}

TEST(CameraMoves, PanningMovesTheFocalPointWithTheMouse) {
  Camera camera = camera_at_two();
  const double height = height_at_focal_point(camera);
  EXPECT_NEAR(height, 4 * std::tan(15 * std::acos(-1) / 180), 1e-12);
  pan(camera, 0.25, 0.5);
  expect_near(camera.focal_point, {-0.25 * height, 0.5 * height, 0});
  expect_near(camera.position - camera.focal_point, {0, 0, 2});
}

TEST(CameraMoves, ZoomingEnlarges) {
  Camera camera = camera_at_two();
  const double height = height_at_focal_point(camera);
  zoom(camera, 2);
  EXPECT_NEAR(height_at_focal_point(camera), height / 2, 1e-12);
  set_projection(camera, Projection::orthographic, 10);
  EXPECT_NEAR(height_at_focal_point(camera), height / 2, 1e-12);
  EXPECT_NEAR(length(camera.position), 10, 1e-12);
  zoom(camera, 0.5);
  EXPECT_NEAR(height_at_focal_point(camera), height, 1e-12);
  set_projection(camera, Projection::perspective, 10);
  EXPECT_NEAR(height_at_focal_point(camera), height, 1e-12);
  expect_near(camera.position, {0, 0, 2});
}

TEST(CameraMoves, RollingTurnsThePictureCounterclockwise) {
  Camera camera = camera_at_two();
  roll(camera, 90);
  // What was to the right is above.
  expect_near(camera.up, {1, 0, 0});
}

TEST(CameraMoves, CenteringLooksFromTheSameSide) {
  Camera camera = camera_at_two();
  center(camera, {1, 2, 3});
  expect_near(camera.focal_point, {1, 2, 3});
  expect_near(camera.position, {1, 2, 5});
}

}  // namespace
}  // namespace pellucid::view::camera_moves_test
