// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "expect_error.h"
#include "pellucid/scene/camera_path.h"

namespace {

using namespace pellucid;

constexpr double pi = std::numbers::pi;

/// A camera at an angle of the circle around (1, 2, 3) in the plane of x and y.
Camera on_circle(double degrees, double radius = 5) {
  Camera camera;
  camera.focal_point = {1, 2, 3};
  camera.position = {1 + radius * std::cos(degrees * pi / 180),
                     2 + radius * std::sin(degrees * pi / 180), 3};
  camera.up = {0, 0, 1};
  return camera;
}

double angle_of(const Camera& camera) {
  return std::atan2(camera.position.y - 2, camera.position.x - 1) * 180 / pi;
}

double distance_of(const Camera& camera) {
  return length(camera.position - camera.focal_point);
}

/// Compares what two cameras see.
void expect_same(const Camera& a, const Camera& b, double error) {
  const CameraFrame<double> f = make_camera_frame(a, {4, 3}), g = make_camera_frame(b, {4, 3});
  EXPECT_LT(length(f.position - g.position), error);
  EXPECT_LT(length(f.forward - g.forward), error);
  EXPECT_LT(length(f.right - g.right), error);
  EXPECT_LT(length(f.up - g.up), error);
}

TEST(TurnedCamera, GoesAroundItsAxis) {
  expect_same(turned_camera(on_circle(10), 70), on_circle(80), 1e-14);
  expect_same(turned_camera(on_circle(10), 360), on_circle(10), 1e-14);
  const Camera over = turned_camera(on_circle(0), 90, Vec3<double>{0, -2, 0});
  EXPECT_LT(length(over.position - Vec3<double>{1, 2, 8}), 1e-14);
  EXPECT_LT(length(over.up - Vec3<double>{-1, 0, 0}), 1e-14);
  expect_error([] { turned_camera(on_circle(0), 1, Vec3<double>{}); }, {"axis has no length"});
}

TEST(CameraPath, PassesThroughItsCameras) {
  Camera near = on_circle(120, 2);
  near.focal_point = near.focal_point + Vec3<double>{0.5, 0, -1};
  near.up = {0.3, 0.1, 1};
  near.vertical_angle = 12;
  const std::vector<CameraKey> keys{
      {on_circle(0), 0.0}, {near, 1.0}, {on_circle(-170, 9), 3.5}, {on_circle(-175, 9), 4.0}};
  const CameraPath path(keys, 4);
  for (const CameraKey& key : keys) expect_same(path.at(*key.at), key.camera, 1e-9);
  expect_same(path.at(-1), keys.front().camera, 1e-9);
  expect_same(path.at(9), keys.back().camera, 1e-9);
}

// Between two views, half a turn apart at most, there is one arc.
TEST(CameraPath, TurnsAlongAnArc) {
  const CameraPath path({{on_circle(20), {}}, {on_circle(110), {}}}, 2);
  for (const double share : {0.0, 0.1, 0.5, 0.77, 1.0}) {
    expect_same(path.at(2 * share), on_circle(20 + 90 * share), 1e-9);
  }
  // Seen from opposite sides: either way around is right, through the middle is not.
  const CameraPath half({{on_circle(0), {}}, {on_circle(180), {}}}, 1);
  EXPECT_NEAR(distance_of(half.at(0.5)), 5, 1e-9);
  EXPECT_NEAR(std::abs(angle_of(half.at(0.25))), 45, 1e-9);
}

TEST(CameraPath, NearsByLogarithms) {
  Camera far = on_circle(0, 8);
  far.vertical_angle = 40;
  Camera close = on_circle(0, 2);
  close.vertical_angle = 10;
  const Camera middle = CameraPath({{far, 0.0}, {close, 1.0}}, 1).at(0.5);
  EXPECT_NEAR(distance_of(middle), 4, 1e-9);
  EXPECT_NEAR(middle.vertical_angle, 20, 1e-9);
  far.projection = close.projection = Projection::orthographic;
  far.parallel_scale = 9;
  close.parallel_scale = 1;
  EXPECT_NEAR(CameraPath({{far, 0.0}, {close, 1.0}}, 1).at(0.5).parallel_scale, 3, 1e-9);
}

// Four views around an object: a circle, at one speed, which ends where it begins.
TEST(CameraPath, GoesRoundAtOneSpeed) {
  std::vector<CameraKey> keys;
  for (const double degrees : {0.0, 60.0, 180.0, 270.0}) keys.push_back({on_circle(degrees), {}});
  const double seconds = 6;
  const CameraPath path(keys, seconds, true);
  constexpr int frames = 600;
  double last = 0, turned = 0;
  for (int i = 1; i <= frames; ++i) {
    const Camera camera = path.at(seconds * i / frames);
    EXPECT_NEAR(distance_of(camera), 5, 1e-9) << i;
    EXPECT_NEAR(camera.position.z, 3, 1e-9) << i;
    const double angle = angle_of(camera);
    const double step = std::remainder(angle - last, 360.0);
    EXPECT_NEAR(step, 360.0 / frames, 1e-3 * 360 / frames) << i;
    turned += step;
    last = angle;
  }
  EXPECT_NEAR(turned, 360, 1e-9);
}

// A corner would show: velocities on both sides of a key differ by what an interval of 1 ms does.
TEST(CameraPath, HasNoCorners) {
  Camera above = on_circle(80, 3);
  above.position.z = 7;
  const CameraPath path({{on_circle(0), 0.0}, {above, 1.0}, {on_circle(90, 6), 1.7}}, 2);
  const double h = 1e-5;
  const auto position = [&](double t) { return path.at(t).position; };
  const Vec3<double> before = (position(1) - position(1 - h)) * (1 / h);
  const Vec3<double> after = (position(1 + h) - position(1)) * (1 / h);
  EXPECT_GT(length(before), 1);
  EXPECT_LT(length(after - before), 1e-2 * length(before));
}

// A slow move, a quick one and a slow one: the slow ones do not swing past their ends.
TEST(CameraPath, DoesNotOvershootAtUnevenTimes) {
  const CameraPath path(
      {{on_circle(0), 0.0}, {on_circle(14), 3.0}, {on_circle(180), 3.2}, {on_circle(190), 7.5}}, 8);
  double last = 0;
  for (int i = 0; i <= 800; ++i) {
    const Camera camera = path.at(i / 100.0);
    const double angle = std::fmod(angle_of(camera) + 720.001, 360.0);
    EXPECT_GE(angle, last - 1e-9) << i;
    EXPECT_NEAR(distance_of(camera), 5, 1e-9);
    if (i <= 300) {
      EXPECT_LE(angle, 14.002) << i;
    }
    last = angle;
  }
  EXPECT_NEAR(last, 190, 0.01);
}

TEST(CameraPath, TakesEqualCamerasForOne) {
  const CameraPath path({{on_circle(0), {}}, {on_circle(0), {}}, {on_circle(90), {}}}, 1);
  expect_same(path.at(0.5), on_circle(45), 1e-9);
  const CameraPath still({{on_circle(7), {}}, {on_circle(7), {}}}, 1, true);
  expect_same(still.at(0.5), on_circle(7), 1e-9);
}

TEST(CameraPath, RefusesWhatIsNoPath) {
  const Camera camera = on_circle(0);
  const auto refuses = [](const std::vector<CameraKey>& keys, const char* words,
                          bool is_closed = false) {
    expect_error([&] { CameraPath(keys, 2, is_closed); }, {words});
  };
  refuses({}, "has no camera");
  refuses({{camera, 0.0}, {camera, {}}}, "camera 2 has no \"at\"");
  refuses({{camera, {}}, {camera, 1.0}}, "camera 2 has \"at\"");
  refuses({{camera, 1.0}, {camera, 1.0}}, "camera 2 is not later");
  refuses({{camera, 0.0}, {camera, 3.0}}, "camera 2 is at 3");
  refuses({{camera, -1.0}}, "camera 1 is at -1");
  refuses({{camera, 0.0}, {camera, std::nan("")}}, "camera 2 is at nan");
  refuses({{camera, 0.0}, {camera, 2.0}}, "its last camera is at the end", true);
  Camera parallel = camera;
  parallel.projection = Projection::orthographic;
  refuses({{camera, {}}, {parallel, {}}}, "another projection");
  Camera blind = camera;
  blind.position = blind.focal_point;
  refuses({{camera, {}}, {blind, {}}}, "camera");
}

}  // namespace
