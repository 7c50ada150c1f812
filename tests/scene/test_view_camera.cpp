// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "pellucid/scene/view_camera.h"
#include "pellucid/scene/volume.h"

namespace {

using namespace pellucid;

Volume box_volume() {
  Volume::Description description;
  description.dimensions = {4, 6, 9};
  description.placement.origin = {-10, 20, 5};
  description.placement.spacing = {1, 2, 0.5};
  description.name = "box";
  return Volume(description, std::vector<float>(4 * 6 * 9, 1.0F));
}

// Every corner of the box is inside of the image, and the view is not wastefully far.
TEST(View, HoldsTheVolume) {
  const Volume volume = box_volume();
  for (const std::string& name : view_names()) {
    for (const ImageSize size : {ImageSize{64, 64}, ImageSize{200, 50}, ImageSize{30, 90}}) {
      const Camera camera = view_camera(volume.world_corners(), name, size);
      const CameraFrame<double> frame = make_camera_frame(camera, size);
      double widest = 0;
      for (const Vec3<double>& corner : volume.world_corners()) {
        const Vec3<double> offset = corner - frame.position;
        const double depth = dot(offset, frame.forward);
        ASSERT_GT(depth, 0) << name;
        const double x = dot(offset, frame.right) / dot(frame.right, frame.right) / depth;
        const double y = dot(offset, frame.up) / dot(frame.up, frame.up) / depth;
        widest = std::max({widest, std::abs(x), std::abs(y)});
      }
      EXPECT_LE(widest, 1) << name;
      if (name != "oblique") {
        EXPECT_GE(widest, 0.9) << name;
      }
    }
  }
}

// World of LPS: x grows to the patient's left, y to the back, z upwards.
TEST(View, StandsOnTheSideNamed) {
  const Volume volume = box_volume();
  const auto position = [&](const char* name) {
    const Camera camera = view_camera(volume.world_corners(), name, {64, 64});
    return camera.position - camera.focal_point;
  };
  EXPECT_LT(position("front").y, 0);
  EXPECT_GT(position("back").y, 0);
  EXPECT_GT(position("left").x, 0);
  EXPECT_LT(position("right").x, 0);
  EXPECT_GT(position("top").z, 0);
  EXPECT_LT(position("bottom").z, 0);
  // Seen from the front, the patient's left is on the right of the image.
  const CameraFrame<double> front =
      make_camera_frame(view_camera(volume.world_corners(), "front", {64, 64}), {64, 64});
  EXPECT_GT(front.right.x, 0);
  EXPECT_GT(front.up.z, 0);
}

Camera camera_at(Vec3<double> position) {
  Camera camera;
  camera.focal_point = {1, 2, 3};
  camera.position = camera.focal_point + position;
  camera.up = {0, 0, 2};
  return camera;
}

void expect_near(const Vec3<double>& v, const Vec3<double>& expected) {
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(v[a], expected[a], 1e-12);
}

// As vtkCamera::Azimuth() and Elevation() do, of a camera that looks along +y.
TEST(View, TurnsAroundTheFocalPoint) {
  Camera camera = camera_at({0, -4, 0});
  turn_camera(camera, 90, 0);
  expect_near(camera.position - camera.focal_point, {4, 0, 0});
  expect_near(camera.up, {0, 0, 2});
  camera = camera_at({0, -4, 0});
  turn_camera(camera, 0, 30);
  expect_near(camera.position - camera.focal_point, {0, -2 * std::sqrt(3.0), 2});
  expect_near(camera.up, {0, 0.5, std::sqrt(3.0) / 2});
  camera = camera_at({0, -4, 0});
  turn_camera(camera, 90, 90);
  expect_near(camera.position - camera.focal_point, {0, 0, 4});
  expect_near(camera.up, {-1, 0, 0});
  expect_near(camera.focal_point, {1, 2, 3});
}

TEST(View, EnlargesThePicture) {
  Camera camera = camera_at({0, -4, 0});
  zoom_camera(camera, 2);
  expect_near(camera.position - camera.focal_point, {0, -2, 0});
  camera.projection = Projection::orthographic;
  camera.parallel_scale = 6;
  zoom_camera(camera, 4);
  EXPECT_EQ(camera.parallel_scale, 1.5);
}

}  // namespace
