// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "pellucid/reference/render.h"
#include "pellucid/scene/error.h"
#include "src/reference/camera.h"
#include "tests/scenes/peers.h"
#include "tests/support/one_layer.h"

namespace pellucid::test_render {
namespace {

Scene small_scene() {
  return scenes::ray_splitting_scene(17, {13, 9}).scene;
}

/// A field with no symmetry: bright where x, y and z are near 1, red to the right, green upwards.
Scene corner_scene(Projection projection) {
  Volume::Description d;
  d.dimensions = {3, 3, 3};
  d.placement.origin = {-1, -1, -1};
  std::vector<float> values;
  for (int i = 0; i < 27; ++i) values.push_back(static_cast<float>((i % 3) + (i / 3) % 3) / 4);
  Scene scene;
  test::volume_of(scene).volume = std::make_shared<const Volume>(d, VolumeData(values));
  test::volume_of(scene).transfer_function = std::make_shared<const TransferFunction>(
      std::vector<TransferFunction::Point>{{0, 0, {1, 1, 1}}, {1, 4, {1, 1, 1}}});
  scene.camera.projection = projection;
  scene.camera.position = {0, 0, 6};
  scene.camera.vertical_angle = 40;
  scene.camera.parallel_scale = 1.5;
  scene.size = {24, 16};
  return scene;
}

/// The image against single rays of the camera that the fast path uses: two cameras, one picture.
TEST(ReferenceRender, PixelsAreTheRaysOfTheCamera) {
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    Scene scene = corner_scene(projection);
    scene.camera.position = {2.5, -3, 4};
    scene.camera.up = {0.3, 1, 0.2};
    RenderOptions options;
    options.outputs.depth = true;
    const Image image = render_reference(scene, options).image;
    const CameraFrame<double> frame = make_camera_frame(scene.camera, scene.size);
    int lit = 0;
    for (int row = 0; row < image.height; ++row) {
      for (int column = 0; column < image.width; ++column) {
        const Ray<double> ray = frame.ray(column, row);
        const ReferencePixel pixel =
            reference_ray(*test::volume_of(scene).volume, *test::volume_of(scene).transfer_function,
                          ray.origin, ray.direction);
        EXPECT_NEAR(static_cast<double>(image.at(column, row)[0]), pixel.radiance.r, 1e-7);
        EXPECT_NEAR(static_cast<double>(image.at(column, row)[3]), pixel.opacity, 1e-7);
        const float depth = image.depth[static_cast<std::size_t>(row * image.width + column)];
        if (pixel.opacity > 0) {
          ++lit;
          EXPECT_NEAR(static_cast<double>(depth), pixel.half_opacity_depth, 1e-6);
        } else {
          EXPECT_TRUE(std::isinf(depth));
        }
      }
    }
    EXPECT_GT(lit, 50);
  }
}

TEST(ReferenceRender, TopLeftIsUpAndLeft) {
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    const Scene scene = corner_scene(projection);
    const Image image = render_reference(scene).image;
    // The field grows with x (to the right, seen from +z) and with y (up).
    EXPECT_GT(image.at(15, 4)[3], image.at(8, 4)[3]);
    EXPECT_GT(image.at(15, 4)[3], image.at(15, 11)[3]);
    EXPECT_GT(image.at(8, 4)[3], image.at(8, 11)[3]);
    // As wide as high: the box ends at the same distance to the sides as to top and bottom.
    EXPECT_EQ(image.at(2, 4)[3], 0);
    EXPECT_EQ(image.at(21, 4)[3], 0);
  }
}

TEST(ReferenceRender, IsBitwiseTheSameForAnyNumberOfThreads) {
  RenderOptions options;
  options.outputs.depth = true;
  options.machine.threads = 1;
  const auto [one, report] = render_reference(small_scene(), options);
  EXPECT_EQ(report.rays, 13u * 9u);
  EXPECT_GT(report.cells, report.rays);
  EXPECT_EQ(report.threads, 1);
  for (const int threads : {2, 3}) {
    options.machine.threads = threads;
    const Image many = render_reference(small_scene(), options).image;
    EXPECT_EQ(one.pixels, many.pixels);
    EXPECT_EQ(one.depth, many.depth);
  }
}

TEST(ReferenceRender, ReportsProgressAndStopsWhenAsked) {
  RenderOptions options;
  double last = 0;
  options.monitor.progress = [&](double done) {
    EXPECT_GT(done, last);
    last = done;
    return true;
  };
  render_reference(small_scene(), options);
  EXPECT_EQ(last, 1);
  options.monitor.progress = [](double) { return false; };
  EXPECT_THROW(render_reference(small_scene(), options), Cancelled);
}

TEST(ReferenceRender, RefusesFieldsOfOnesOwn) {
  class Nothing : public StretchSource {
   public:
    Nothing() : StretchSource({"nothing", {{0, 0, 0}, {1, 1, 1}}, {{"x", 0, 1}}}) {}
    std::unique_ptr<StretchStream> stream(const StretchDemand&) const override { return nullptr; }
  };
  Scene scene = small_scene();
  const auto function =
      std::make_shared<const TransferFunction>(std::vector<TransferFunction::Point>{{0, 1, {}}});
  scene.layers.push_back({SourceContent{std::make_shared<const Nothing>(), function}});
  try {
    render_reference(scene);
    ADD_FAILURE() << "rendered";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "reference: layer 2 has a stretch source, which the reference does "
                 "not know; leave it out");
  }
}

TEST(ReferenceRender, RefusesWhatRenderRefuses) {
  EXPECT_THROW(render_reference(Scene{}), Error);
  Scene scene = small_scene();
  scene.camera.focal_point = scene.camera.position;
  EXPECT_THROW(render_reference(scene), Error);
  scene = small_scene();
  scene.size.width = 0;
  EXPECT_THROW(render_reference(scene), Error);
  for (const int samples : {-1, 0, 65}) {
    scene = small_scene();
    scene.samples = samples;
    EXPECT_THROW(render_reference(scene), Error);
  }
  RenderOptions options;
  options.machine.threads = -1;
  EXPECT_THROW(render_reference(small_scene(), options), Error);
}

/// Method, precision, step, tolerance and grade are for the fast path only.
TEST(ReferenceRender, LooksAtTheFieldAndTheCameraOnly) {
  const Image image = render_reference(small_scene()).image;
  Scene other = small_scene();
  other.integration = {Method::rectangle, Precision::float64, 7};
  EXPECT_EQ(image.pixels, render_reference(other).image.pixels);
  other.integration = {Method::exact, Precision::automatic, 7, 0.1, Grade::proved};
  EXPECT_EQ(image.pixels, render_reference(other).image.pixels);
}

/// A pixel of n × n samples is the mean of the n × n pixels of an image that much finer.
TEST(ReferenceRender, SamplesAreThePixelsOfAFinerImage) {
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    Scene scene = corner_scene(projection);
    scene.camera.position = {2.5, -3, 4};
    scene.size = {8, 5};
    for (const int n : {2, 3}) {
      Scene fine = scene;
      fine.size = {8 * n, 5 * n};
      fine.samples = 1;
      const Image expected = render_reference(fine).image;
      scene.samples = n;
      const auto [image, report] = render_reference(scene);
      EXPECT_EQ(report.rays, static_cast<std::uint64_t>(8 * 5 * n * n));
      double largest = 0;
      for (int row = 0; row < 5; ++row) {
        for (int column = 0; column < 8; ++column) {
          for (std::size_t c = 0; c < 4; ++c) {
            double mean = 0;
            for (int i = 0; i < n * n; ++i) {
              mean += static_cast<double>(expected.at(n * column + i % n, n * row + i / n)[c]);
            }
            mean /= n * n;
            const double pixel = static_cast<double>(image.at(column, row)[c]);
            largest = std::max(largest, std::abs(mean - pixel));
          }
        }
      }
      EXPECT_LT(largest, 1e-7);
    }
  }
}

/// The two cameras place their samples alike and count them in one order.
TEST(ReferenceRender, SamplesAreTheRaysOfTheCamera) {
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    Scene scene = corner_scene(projection);
    scene.camera.position = {2.5, -3, 4};
    const CameraFrame<double> frame = make_camera_frame(scene.camera, scene.size);
    const reference::CameraRays camera(scene.camera, scene.size);
    for (int n = 0; n < 16; ++n) {
      const Ray<double> fast = frame.ray(5, 11, n, 4);
      const reference::RealRay ray = camera.ray(5, 11, n, 4);
      for (int a = 0; a < 3; ++a) {
        const auto axis = static_cast<std::size_t>(a);
        EXPECT_NEAR(fast.origin[a], static_cast<double>(ray.origin[axis]), 1e-14);
        EXPECT_NEAR(fast.direction[a], static_cast<double>(ray.direction[axis]), 1e-15);
      }
    }
  }
}

TEST(ReferenceRender, DepthOfSamplesIsThatOfTheNearest) {
  Scene scene = corner_scene(Projection::perspective);
  scene.camera.position = {2.5, -3, 4};
  scene.size = {6, 4};
  scene.samples = 3;
  RenderOptions options;
  options.outputs.depth = true;
  const Image image = render_reference(scene, options).image;
  Scene fine = scene;
  fine.size = {18, 12};
  fine.samples = 1;
  const Image samples = render_reference(fine, options).image;
  int partly_empty = 0;
  for (std::size_t p = 0; p < image.depth.size(); ++p) {
    float nearest = std::numeric_limits<float>::infinity(), farthest = 0;
    for (std::size_t i = 0; i < 9; ++i) {
      const std::size_t s = (p / 6 * 3 + i / 3) * 18 + p % 6 * 3 + i % 3;
      nearest = std::min(nearest, samples.depth[s]);
      farthest = std::max(farthest, samples.depth[s]);
    }
    partly_empty += std::isinf(farthest) && !std::isinf(nearest) ? 1 : 0;
    if (std::isinf(nearest)) {
      EXPECT_TRUE(std::isinf(image.depth[p])) << p;
    } else {
      EXPECT_FLOAT_EQ(image.depth[p], nearest) << p;
    }
  }
  EXPECT_GT(partly_empty, 2);
}

}  // namespace
}  // namespace pellucid::test_render
