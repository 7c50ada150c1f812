// SPDX-License-Identifier: Apache-2.0
#include "pellucid/cpu/render.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pellucid/scene/builtin_fields.h"
#include "pellucid/scene/defaults.h"
#include "pellucid/scene/error.h"
#include "tests/support/one_layer.h"

namespace pellucid::test_render {
namespace {

Scene small_scene() {
  Scene scene;
  test::volume_of(scene).volume =
      std::make_shared<Volume>(make_builtin_field("marschner_lobb", 24));
  test::volume_of(scene).transfer_function = std::make_shared<TransferFunction>(
      std::vector<TransferFunction::Point>{{0.3, 0, {1, 0.2, 0.1}},
                                           {0.5, 8, {0.9, 0.8, 0.1}},
                                           {0.55, 0, {0.1, 0.3, 1}},
                                           {1, 2, {0.2, 0.9, 0.4}}});
  scene.size = {37, 29};
  scene.camera = default_camera(*test::volume_of(scene).volume, scene.size);
  return scene;
}

TEST(Render, SameBitsForAnyNumberOfThreads) {
  Scene scene = small_scene();
  for (const Method method : {Method::exact, Method::midpoint}) {
    scene.integration.method = method;
    RenderOptions options;
    options.outputs.depth = true;
    options.machine.threads = 1;
    const Image one = render(scene, options).image;
    for (const int threads : {2, 3, 7}) {
      options.machine.threads = threads;
      const Image many = render(scene, options).image;
      EXPECT_EQ(one.pixels, many.pixels) << threads << " threads";
      EXPECT_EQ(one.depth, many.depth) << threads << " threads";
    }
  }
}

TEST(Render, ReportCountsAndThreads) {
  const Scene scene = small_scene();
  RenderReport report;
  RenderOptions options;
  options.machine.threads = 2;
  report = render(scene, options).report;
  EXPECT_EQ(report.rays, 37u * 29u);
  EXPECT_EQ(report.threads, 2);
  EXPECT_GT(report.cells, 24u * 100u);
  EXPECT_GT(report.seconds, 0);
}

TEST(Render, ProgressRisesToOneAndCancels) {
  const Scene scene = small_scene();
  RenderOptions options;
  double last = 0;
  options.monitor.progress = [&](double share) {
    EXPECT_GT(share, last);
    EXPECT_LE(share, 1);
    last = share;
    return true;
  };
  for (const int threads : {1, 2, 5}) {
    last = 0;
    options.machine.threads = threads;
    render(scene, options);
    EXPECT_EQ(last, 1) << threads << " threads";
  }
  options.monitor.progress = [](double) { return false; };
  EXPECT_THROW(render(scene, options), Cancelled);
}

TEST(Render, RefusesWhatItCannotRender) {
  Scene scene = small_scene();
  scene.integration.method = Method::midpoint;
  for (const double step : {0.0, -1.0, 9e-5, 2e6, std::numeric_limits<double>::quiet_NaN(),
                            std::numeric_limits<double>::infinity()}) {
    scene.integration.step = step;
    EXPECT_THROW(render(scene), Error) << step;
  }
  scene = small_scene();
  scene.size.width = 0;
  EXPECT_THROW(render(scene), Error);
  scene = small_scene();
  test::volume_of(scene).volume.reset();
  EXPECT_THROW(render(scene), Error);
  scene = small_scene();
  test::volume_of(scene).transfer_function.reset();
  EXPECT_THROW(render(scene), Error);
  RenderOptions options;
  options.machine.threads = -1;
  EXPECT_THROW(render(small_scene(), options), Error);
}

/// A slab of constant extinction 2 and color 0.5, 2 thick, seen along z from a parallel camera.
Scene slab(Centering centering) {
  Scene scene;
  Volume::Description d;
  d.dimensions = {8, 8, 8};
  d.centering = centering;
  d.placement.spacing = {0.25, 0.25, centering == Centering::cell ? 0.25 : 2.0 / 7};
  test::volume_of(scene).volume =
      std::make_shared<Volume>(d, VolumeData(std::vector<float>(512, 1.0f)));
  test::volume_of(scene).transfer_function = std::make_shared<TransferFunction>(
      std::vector<TransferFunction::Point>{{0, 2, {0.5, 0.25, 0.125}}});
  scene.camera.projection = Projection::orthographic;
  scene.camera.position = {0.85, 0.85, 10};
  scene.camera.focal_point = {0.85, 0.85, 0};
  scene.camera.parallel_scale = 0.5;
  scene.size = {5, 5};
  return scene;
}

TEST(Render, SlabHasItsClosedFormInEveryMethodAndItsHalfOpacityDepth) {
  for (const Centering centering : {Centering::point, Centering::cell}) {
    Scene scene = slab(centering);
    const double front = 10 - (centering == Centering::cell ? 2 - 0.125 : 2);
    const double alpha = -std::expm1(-4.0);
    const double half = front - std::log1p(-alpha / 2) / 2;
    for (const Method method :
         {Method::exact, Method::rectangle, Method::midpoint, Method::trapezoid, Method::simpson,
          Method::linear, Method::preintegrated}) {
      for (const Precision precision : {Precision::float32, Precision::float64}) {
        scene.integration = {method, precision, 0.37};
        RenderOptions options;
        options.outputs.depth = true;
        const Image image = render(scene, options).image;
        const double tolerance = precision == Precision::float32 ? 1e-6 : 1e-7;
        for (std::size_t i = 0; i < image.pixels.size(); ++i) {
          EXPECT_NEAR(image.pixels[i][0], 0.5 * alpha, tolerance) << method_name(method);
          EXPECT_NEAR(image.pixels[i][1], 0.25 * alpha, tolerance) << method_name(method);
          EXPECT_NEAR(image.pixels[i][2], 0.125 * alpha, tolerance) << method_name(method);
          EXPECT_NEAR(image.pixels[i][3], alpha, tolerance) << method_name(method);
          EXPECT_NEAR(image.depth[i], half, 2e-6) << method_name(method);
        }
      }
    }
  }
}

TEST(Render, TaylorOnTheSlabIsTheProductOfItsSteps) {
  Scene scene = slab(Centering::point);
  // In voxels of 0.25: eight steps of 0.25 over the length of 2, each of opacity min(1, 2 · 0.25).
  scene.integration = {Method::taylor, Precision::float64, 1.0};
  const double alpha = 1 - std::pow(0.5, 8);
  for (const auto& pixel : render(scene).image.pixels) {
    EXPECT_NEAR(pixel[0], 0.5 * alpha, 1e-7);
    EXPECT_NEAR(pixel[3], alpha, 1e-7);
  }
}

TEST(Render, DepthIsInfiniteWhereNothingIsSeen) {
  Scene scene = slab(Centering::point);
  scene.camera.position.x = scene.camera.focal_point.x = 100;
  RenderOptions options;
  options.outputs.depth = true;
  const Image image = render(scene, options).image;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    EXPECT_EQ(image.pixels[i], (std::array<float, 4>{}));
    EXPECT_EQ(image.depth[i], std::numeric_limits<float>::infinity());
  }
}

}  // namespace
}  // namespace pellucid::test_render
