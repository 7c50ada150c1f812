// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "expect_error.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/look.h"
#include "pellucid/scene/scene.h"

namespace pellucid::test_camera {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

void expect_refused(const Camera& camera, std::initializer_list<const char*> parts,
                    ImageSize size = {}) {
  expect_error([&] { make_camera_frame(camera, size); }, parts);
}

void expect_near(const Vec3<double>& p, const Vec3<double>& q, double tolerance = 1e-14) {
  EXPECT_NEAR(p.x, q.x, tolerance);
  EXPECT_NEAR(p.y, q.y, tolerance);
  EXPECT_NEAR(p.z, q.z, tolerance);
}

TEST(CameraErrors, EachNamesItsKey) {
  Camera c;
  c.position = c.focal_point = {1, 2, 3};
  expect_refused(c, {"camera: position and focal_point", "(1, 2, 3)"});

  c = {};
  c.up = {0, 0, 0};
  expect_refused(c, {"camera: up is (0, 0, 0)"});
  c.up = {0, 0, -4};
  expect_refused(c, {"camera: up (0, 0, -4)", "parallel to the view"});
  c.up = {1e-12, 0, 1};
  expect_refused(c, {"camera: up", "parallel to the view"});

  for (const double bad : {nan, infinity, -infinity}) {
    c = {};
    c.position.x = bad;
    expect_refused(c, {"camera: position", "finite"});
    c = {};
    c.focal_point.y = bad;
    expect_refused(c, {"camera: focal_point", "finite"});
    c = {};
    c.up.z = bad;
    expect_refused(c, {"camera: up", "finite"});
  }
  c = {};
  c.position = {1.5e308, 0, 0};
  c.focal_point = {-1.5e308, 0, 0};
  expect_refused(c, {"focal_point - position", "finite"});

  for (const double bad : {0.0, -30.0, 180.0, 400.0, nan, infinity}) {
    c = {};
    c.vertical_angle = bad;
    expect_refused(c, {"camera: vertical_angle is", "between 0 and 180"});
  }
  for (const double bad : {0.0, -1.0, nan, infinity}) {
    c = {};
    c.projection = Projection::orthographic;
    c.parallel_scale = bad;
    expect_refused(c, {"camera: parallel_scale is", "positive"});
  }
}

TEST(CameraErrors, OnlyWhatTheProjectionUsesIsChecked) {
  Camera c;
  c.parallel_scale = -1;
  EXPECT_NO_THROW(make_camera_frame(c, {}));
  c = {};
  c.projection = Projection::orthographic;
  c.vertical_angle = 500;
  EXPECT_NO_THROW(make_camera_frame(c, {}));
}

TEST(CameraErrors, Size) {
  for (const ImageSize bad : {ImageSize{0, 5}, ImageSize{5, 0}, ImageSize{-1, 5},
                              ImageSize{65537, 5}, ImageSize{5, 65537}}) {
    expect_refused({}, {"image: size is", "from 1 to 65536"}, bad);
  }
  EXPECT_NO_THROW(make_camera_frame({}, {1, 65536}));
}

TEST(Camera, PerspectiveRaysGoThroughPixelCentresFromTheTopLeft) {
  Camera c;
  c.position = {0, 0, 5};
  c.focal_point = {0, 0, 0};
  c.up = {0, 2, 1};  // only its part across the view counts
  c.vertical_angle = 90;
  const CameraFrame<double> frame = make_camera_frame(c, {4, 2});
  expect_near(frame.forward, {0, 0, -1});
  expect_near(frame.up, {0, 1, 0});
  expect_near(frame.right, {2, 0, 0});
  // Image plane at distance 1: y from 1 to -1 in 2 rows, x from -2 to 2 in 4 columns.
  const double x[] = {-1.5, -0.5, 0.5, 1.5}, y[] = {0.5, -0.5};
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 4; ++column) {
      const Ray<double> ray = frame.ray(column, row);
      expect_near(ray.origin, c.position, 0);
      EXPECT_NEAR(length(ray.direction), 1, 1e-15);
      const Vec3<double> on_plane = ray.direction * (-1 / ray.direction.z);
      expect_near(on_plane, {x[column], y[row], -1});
    }
  }
}

TEST(Camera, OrthographicRaysAreParallel) {
  Camera c;
  c.projection = Projection::orthographic;
  c.position = {1, 2, 3};
  c.focal_point = {1, 2, -9};
  c.parallel_scale = 3;
  const CameraFrame<double> frame = make_camera_frame(c, {2, 3});
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 2; ++column) {
      const Ray<double> ray = frame.ray(column, row);
      expect_near(ray.direction, {0, 0, -1});
      expect_near(ray.origin, {1 + 2 * (column - 0.5), 2 + 2.0 * (1 - row), 3});
    }
  }
}

TEST(Camera, FrameIsRightHandedForObliqueViews) {
  Camera c;
  c.position = {3, -4, 5};
  c.focal_point = {-1, 2, 0.5};
  c.up = {0.1, 0.3, 2};
  const CameraFrame<double> frame = make_camera_frame(c, {300, 200});
  EXPECT_NEAR(dot(frame.forward, frame.up), 0, 1e-15);
  EXPECT_NEAR(dot(frame.forward, frame.right), 0, 1e-15);
  EXPECT_NEAR(dot(frame.right, frame.up), 0, 1e-15);
  EXPECT_GT(dot(frame.up, c.up), 0);
  const double half = std::tan(15 * std::numbers::pi / 180);
  EXPECT_NEAR(length(frame.up), half, 1e-15);
  EXPECT_NEAR(length(frame.right), 1.5 * half, 1e-15);
  EXPECT_NEAR(dot(cross(normalized(frame.right), normalized(frame.up)), frame.forward), -1, 1e-15);
}

TEST(Camera, AxesAreOfLengthOneAndThoseOfTheFrame) {
  Camera c;
  c.position = {3, -4, 5};
  c.focal_point = {-1, 2, 0.5};
  c.up = {0.1, 0.3, 2};
  const CameraAxes axes = camera_axes(c);
  for (const Vec3<double>& axis : {axes.right, axes.up, axes.forward}) {
    EXPECT_NEAR(length(axis), 1, 1e-15);
  }
  expect_near(cross(axes.right, axes.up), -axes.forward);
  const CameraFrame<double> frame = make_camera_frame(c, {300, 200});
  EXPECT_EQ(frame.forward, axes.forward);
  expect_near(normalized(frame.right), axes.right);
  expect_near(normalized(frame.up), axes.up);
  // Of a number that the axes do not need, they ask nothing.
  c.vertical_angle = 200;
  EXPECT_EQ(camera_axes(c).up, axes.up);
  c.up = c.focal_point - c.position;
  EXPECT_THROW(camera_axes(c), Error);
  EXPECT_THROW(look_lights(c), Error);
}

TEST(Camera, TinyAndHugeDistancesKeepTheirDirection) {
  for (const double scale : {1e-300, 1e-160, 1e160, 1e300}) {
    Camera c;
    c.position = {3 * scale, 0, 4 * scale};
    c.focal_point = {0, 0, 0};
    c.up = {0, scale, 0};
    const CameraFrame<double> frame = make_camera_frame(c, {1, 1});
    expect_near(frame.forward, {-0.6, 0, -0.8});
    expect_near(frame.ray(0, 0).direction, {-0.6, 0, -0.8});
  }
}

TEST(Method, NamesGoBothWays) {
  const char* names[] = {"exact",       "rectangle", "taylor",        "midpoint", "trapezoid",
                         "simpson",     "linear",    "preintegrated", "kniss",    "gaussian",
                         "homogeneous", "average",   "partial"};
  for (const char* name : names) {
    const std::optional<Method> method = method_from_name(name);
    ASSERT_TRUE(method.has_value()) << name;
    EXPECT_EQ(method_name(*method), name);
  }
  EXPECT_EQ(method_from_name("exact"), Method::exact);
  EXPECT_EQ(method_from_name("linear"), Method::linear);
  EXPECT_FALSE(method_from_name("Exact").has_value());
  EXPECT_FALSE(method_from_name("").has_value());
}

}  // namespace
}  // namespace pellucid::test_camera
