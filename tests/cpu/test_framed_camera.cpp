// SPDX-License-Identifier: Apache-2.0
#include "pellucid/cpu/framed_camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "pellucid/scene/builtin_fields.h"
#include "pellucid/scene/defaults.h"

namespace pellucid::test_framed_camera {
namespace {

using Points = std::vector<TransferFunction::Point>;

std::shared_ptr<const TransferFunction> step(double from, double extinction) {
  return std::make_shared<const TransferFunction>(
      Points{{from, 0, {1, 1, 1}}, {from * 1.0001, extinction, {1, 1, 1}}});
}

Scene scene_of(Layer layer, ImageSize size) {
  Scene scene;
  scene.layers = {std::move(layer)};
  scene.size = size;
  scene.camera = default_camera(world_corners(scene), size);
  return scene;
}

Layer sphere(int points, double extinction = 1e3) {
  return {VolumeContent{std::make_shared<const Volume>(make_builtin_field("sphere", points)),
                        step(0.5, extinction), nullptr}};
}

// The part of the picture, from 0 to 1, in which pixels have an opacity of 5 % or more.
struct Part {
  double left = 1, right = 0, top = 1, bottom = 0;
};
Part seen_in(const Scene& scene) {
  Part part;
  const Image image = render(scene).image;
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      if (image.at(column, row)[3] < 0.05F) continue;
      part.left = std::min(part.left, 1.0 * column / image.width);
      part.right = std::max(part.right, (column + 1.0) / image.width);
      part.top = std::min(part.top, 1.0 * row / image.height);
      part.bottom = std::max(part.bottom, (row + 1.0) / image.height);
    }
  }
  return part;
}

void expect_framed(Scene scene) {
  scene.camera = framed_camera(scene, scene.camera);
  const Part part = seen_in(scene);
  const double filled = std::max(part.right - part.left, part.bottom - part.top);
  EXPECT_NEAR(filled, framed_share, 0.025);
  EXPECT_NEAR(part.left + part.right, 1, 0.03);
  EXPECT_NEAR(part.top + part.bottom, 1, 0.03);
}

// Blocks of 8 cells would show the ball of 17 points small and off-center.
TEST(FramedCamera, FillsThePictureWhateverTheResolution) {
  for (const int points : {16, 17, 33, 96}) {
    SCOPED_TRACE(points);
    expect_framed(scene_of(sphere(points), {160, 160}));
  }
}

TEST(FramedCamera, FillsWideAndHighPictures) {
  expect_framed(scene_of(sphere(33), {240, 100}));
  expect_framed(scene_of(sphere(33), {90, 200}));
}

TEST(FramedCamera, FramesASmallThingInACorner) {
  Volume::Description description;
  description.dimensions = {60, 60, 60};
  description.name = "corner";
  std::vector<float> values(60 * 60 * 60, 0);
  for (std::size_t k = 3; k < 9; ++k) {
    for (std::size_t j = 40; j < 46; ++j) {
      for (std::size_t i = 50; i < 56; ++i) values[(k * 60 + j) * 60 + i] = 1;
    }
  }
  Layer layer{
      VolumeContent{std::make_shared<const Volume>(description, values), step(0.5, 1e2), nullptr}};
  expect_framed(scene_of(layer, {128, 128}));
  layer.transform.matrix.column[0] = {0, 3, 0};
  layer.transform.matrix.column[1] = {-1, 0, 0};
  expect_framed(scene_of(layer, {128, 128}));
}

TEST(FramedCamera, FramesOrthographicViews) {
  Scene scene = scene_of(sphere(33), {120, 120});
  scene.camera.projection = Projection::orthographic;
  scene.camera.parallel_scale = 7;
  expect_framed(scene);
  scene.camera.parallel_scale = 0.1;  // more lies outside of the first draft
  expect_framed(scene);
}

// In perspective the near end grows faster than the far one, and leaves the middle.
TEST(FramedCamera, FramesLongThingsThatPointAtTheEye) {
  Volume::Description description;
  description.dimensions = {40, 40, 40};
  description.name = "rod";
  std::vector<float> values(64000, 0);
  const auto bend = [](int along) { return static_cast<std::size_t>(6 + along * along / 80); };
  for (int along = 2; along < 38; ++along) {
    for (std::size_t k = bend(along); k < bend(along) + 8; ++k) {
      for (std::size_t i = 4 + bend(along) / 2; i < 12 + bend(along) / 2; ++i) {
        values[(k * 40 + static_cast<std::size_t>(along)) * 40 + i] = 1;
      }
    }
  }
  const Layer layer{
      VolumeContent{std::make_shared<const Volume>(description, values), step(0.5, 1e2), nullptr}};
  for (const ImageSize size : {ImageSize{120, 100}, ImageSize{96, 120}, ImageSize{180, 150},
                               ImageSize{110, 100}, ImageSize{128, 128}}) {
    SCOPED_TRACE(testing::Message() << size.width << " x " << size.height);
    expect_framed(scene_of(layer, size));
  }
}

// A ball of radius 0.2 among single voxels that are seen far out.
TEST(FramedCamera, LeavesOutliersOutside) {
  constexpr std::size_t n = 65;
  std::vector<float> values(n * n * n, 0);
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t i = 0; i < n; ++i) {
        const auto from_center = [](std::size_t at) { return static_cast<double>(at) / 64 - 0.5; };
        const double radius = std::hypot(from_center(i), from_center(j), from_center(k));
        values[(k * n + j) * n + i] = static_cast<float>(std::clamp(15 - 64 * radius, 0.0, 2.0));
      }
    }
  }
  values[(32 * n + 32) * n + 1] = 2;
  Volume::Description description;
  description.dimensions = {n, n, n};
  description.name = "ball";
  const Layer layer{
      VolumeContent{std::make_shared<const Volume>(description, values), step(1, 1e2), nullptr}};
  Scene scene = scene_of(layer, {128, 128});
  const Camera camera = framed_camera(scene, scene.camera);
  // The ball's diameter of 28 voxels over 0.88 of the picture's height, less for the perspective.
  const double height = 2 * length(camera.position - camera.focal_point) *
                        std::tan(camera.vertical_angle * std::numbers::pi / 360);
  EXPECT_NEAR(height * framed_share, 29, 2);
}

TEST(FramedCamera, StaysWhereNothingIsSeen) {
  Scene scene = scene_of(sphere(16, 0), {64, 64});
  EXPECT_EQ(framed_camera(scene, scene.camera).position, scene.camera.position);
}

TEST(FramedCamera, CanBeCancelled) {
  const Scene scene = scene_of(sphere(33), {64, 64});
  FrameMonitor monitor;
  monitor.progress = [](double) { return false; };
  EXPECT_THROW(framed_camera(scene, scene.camera, {}, monitor), Cancelled);
}

}  // namespace
}  // namespace pellucid::test_framed_camera
