// SPDX-License-Identifier: Apache-2.0
//
// Light and surfaces whose pixels are known; the scenes of the tolerance matrix hold them against
// the reference (tests/scenes/gallery/light.cpp).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "pellucid/cpu/render.h"
#include "pellucid/scene/error.h"
#include "src/cpu/layers/layer_appearance.h"
#include "tests/scenes/makers.h"

namespace pellucid::test_light {
namespace {

/// v = a x + b y + c z on [-1, 1]³, of constant extinction and color, seen along -z.
struct Ramp {
  Vec3<double> slope{3, 0, 4};
  int points = 6;

  Layer layer(double extinction, Rgb<double> color = {0.5, 0.25, 1}) const {
    const auto data = scenes::sampled(
        {points, points, points},
        [this](double x, double y, double z) { return slope.x * x + slope.y * y + slope.z * z; },
        "ramp");
    return {VolumeContent{data, scenes::transfer({{0, extinction, color}}), nullptr}};
  }
};

Scene seen(Layer layer, double tolerance = 1e-5) {
  Scene scene;
  scene.layers = {std::move(layer)};
  scene.camera.projection = Projection::orthographic;
  scene.camera.position = {0.013, 0.021, 5};
  scene.camera.focal_point = {0.013, 0.021, 0};
  scene.camera.up = {0, 1, 0};
  scene.camera.parallel_scale = 0.2;
  scene.size = {3, 3};
  scene.integration.tolerance = tolerance;
  return scene;
}

std::array<double, 4> pixel(const Scene& scene, bool* said = nullptr) {
  RenderOptions options;
  options.outputs.error = true;
  options.machine.threads = 1;
  const Image image = render(scene, options).image;
  if (said != nullptr) {
    *said = std::ranges::all_of(image.error, [&](float error) {
      return static_cast<double>(error) <= scene.integration.tolerance;
    });
  }
  const auto& p = image.at(1, 1);
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2]),
          static_cast<double>(p[3])};
}

void expect_near(const std::array<double, 4>& pixel, const std::array<double, 4>& truth,
                 double within = 2e-6) {
  for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(pixel[c], truth[c], within) << "channel " << c;
}

TEST(Light, ALitRampHasOneShade) {
  for (const GradientKind kind : {GradientKind::smooth, GradientKind::field}) {
    Layer layer = Ramp{}.layer(0.7);
    layer.shading = Shading{0.1, 0.6, 0.3, 5, kind, 0};
    // n·l = 4/5 under a head light along z.
    const double opacity = -std::expm1(-1.4), shade = 0.1 + 0.6 * 0.8;
    const double shine = 0.3 * std::pow(0.8, 5);
    const Scene scene = seen(layer);
    expect_near(pixel(scene), {opacity * (0.5 * shade + shine), opacity * (0.25 * shade + shine),
                               opacity * (shade + shine), opacity});
  }
}

TEST(Light, FlatnessShortensTheNormal) {
  Layer layer = Ramp{}.layer(0.7);
  layer.shading = Shading{0, 1, 0, 5, GradientKind::smooth, 0.1};
  // g0 = 0.1 (range 14) / (voxel 0.4) = 3.5; |g| = 5.
  const double opacity = -std::expm1(-1.4), shade = 4 / std::hypot(5, 3.5);
  expect_near(pixel(seen(layer)),
              {0.5 * opacity * shade, 0.25 * opacity * shade, opacity * shade, opacity}, 4e-6);
}

TEST(Light, LightsAddAndHaveColors) {
  Layer layer = Ramp{}.layer(0.7, {1, 1, 1});
  layer.shading = Shading{0.2, 0.5, 0, 5, GradientKind::smooth, 0};
  Scene scene = seen(layer);
  // Along -x, so |n·l| = 3/5; and a point light far away along z.
  scene.lights = {{DirectionalLight{{-7, 0, 0}}, {1, 0.5, 0}},
                  {PointLight{{0, 0, 1e9}}, {0, 0, 1}}};
  const double opacity = -std::expm1(-1.4);
  expect_near(pixel(scene), {opacity * (0.2 + 0.5 * 0.6), opacity * (0.2 + 0.25 * 0.6),
                             opacity * (0.2 + 0.5 * 0.8), opacity});
  scene.lights.clear();
  expect_near(pixel(scene), {0.2 * opacity, 0.2 * opacity, 0.2 * opacity, opacity});
}

/// Bounds that are proved come together slowly: a ray gives them up after some thousand panels.
TEST(Light, WhereProofsAreGivenUpThePictureIsThatOfTheEstimate) {
  const auto data = scenes::sampled(
      {7, 6, 60},
      [](double x, double y, double z) { return std::sin(40 * z) + x * y + std::cos(31 * z + x); },
      "waves");
  Layer layer{VolumeContent{
      data, scenes::transfer({{-2, 0.2, {0.2, 0.5, 1}}, {2, 1.2, {1, 0.8, 0.3}}}), nullptr}};
  layer.shading = Shading{};
  layer.shading->flatness = 0;
  Scene scene = seen(layer, 1e-5);
  const auto estimated = pixel(scene);
  scene.integration.grade = Grade::proved;
  bool said = true;
  const auto proved = pixel(scene, &said);
  EXPECT_FALSE(said);
  expect_near(proved, estimated, 3e-5);
}

TEST(Light, AnUnlitLayerIgnoresLights) {
  Scene scene = seen(Ramp{}.layer(0.7));
  const auto plain = pixel(scene);
  scene.lights = {{DirectionalLight{{1, 1, 1}}, {0, 0, 0}}};
  expect_near(pixel(scene), plain, 0);
}

TEST(Light, GradientOpacityIsAFactorOfTheExtinction) {
  Layer layer = Ramp{}.layer(0.7, {1, 1, 1});
  // |g| = 5 per world length, 2 per voxel of 0.4.
  layer.gradient_opacity =
      std::make_shared<const GradientOpacity>(std::vector<GradientOpacity::Point>{{0, 0}, {10, 1}});
  const double half = -std::expm1(-0.7);
  expect_near(pixel(seen(layer)), {half, half, half, half});
  layer.gradient_opacity = std::make_shared<const GradientOpacity>(
      std::vector<GradientOpacity::Point>{{0, 0}, {4, 1}}, GradientOpacity::Unit::voxel);
  expect_near(pixel(seen(layer)), {half, half, half, half});
}

TEST(Light, AnIsosurfaceLiesInTheMedium) {
  Layer layer = Ramp{{0, 0, 1}}.layer(0.5, {1, 0, 0});
  layer.isosurfaces = {{0.25, 0.6, {0, 1, 0}}};
  const double front = -std::expm1(-0.5 * 0.75), back = -std::expm1(-0.5 * 1.25);
  const double left = (1 - front) * 0.4;
  expect_near(pixel(seen(layer)),
              {front + left * back, (1 - front) * 0.6, 0, 1 - left * (1 - back)});
}

TEST(Light, IsosurfacesAreFoundAtFacesOfCells) {
  // The value 0 is that of a plane of values.
  Layer layer = Ramp{{0, 0, 1}, 7}.layer(0, {1, 0, 0});
  layer.isosurfaces = {{0, 0.5, {0, 1, 0}}};
  bool said = false;
  expect_near(pixel(seen(layer), &said), {0, 0.5, 0, 0.5}, 1e-7);
  EXPECT_TRUE(said);
}

TEST(Light, AnOpaqueSurfaceEndsTheRayAndHasItsDepth) {
  Layer layer = Ramp{{0, 0, 1}}.layer(0, {1, 1, 1});
  layer.isosurfaces = {{0.5, 1, {0, 1, 0}}, {-0.5, 1, {1, 0, 0}}};
  layer.shading = Shading{0.3, 0.5, 0, 1, GradientKind::smooth, 0};
  const Scene scene = seen(layer);
  RenderOptions options;
  options.outputs.depth = true;
  const Image image = render(scene, options).image;
  EXPECT_NEAR(static_cast<double>(image.at(1, 1)[1]), 0.8, 1e-6);
  EXPECT_EQ(image.at(1, 1)[0], 0);
  EXPECT_EQ(image.at(1, 1)[3], 1);
  EXPECT_NEAR(static_cast<double>(image.depth[4]), 4.5, 1e-6);
}

TEST(Light, SurfacesAtOnePlaceAreAMixture) {
  Layer first = Ramp{{0, 0, 1}}.layer(0), second = Ramp{{0, 0, 2}}.layer(0);
  first.isosurfaces = {{0.25, 0.5, {1, 0, 0}}};
  second.isosurfaces = {{0.5, 0.75, {0, 1, 0}}};
  Scene scene = seen(first);
  scene.layers.push_back(second);
  const auto one = pixel(scene);
  // Depths ln 2 and 2 ln 2.
  expect_near(one, {0.875 / 3, 0.875 * 2 / 3, 0, 0.875});
  std::swap(scene.layers[0], scene.layers[1]);
  expect_near(pixel(scene), one, 1e-7);
}

TEST(Light, ASliceShowsTheColorsOfItsValues) {
  Layer layer = Ramp{{1, 0, 0}}.layer(0);
  layer.slices = {
      {{0, 0, 0.5}, {0, 0, 3}, 0.5, scenes::transfer({{-1, 0, {0, 0, 0}}, {1, 0, {1, 1, 1}}})},
      {{0, 0, -1}, {0, 0, 1}, 1}};  // on the border
  const double value = 0.5 * (1 + 0.013);
  expect_near(pixel(seen(layer)),
              {0.5 * value + 0.5 * 0.5, 0.5 * value + 0.5 * 0.25, 0.5 * value + 0.5, 1});
}

TEST(Light, SurfacesEndAtClips) {
  Layer layer = Ramp{{0, 0, 1}}.layer(0);
  layer.isosurfaces = {{0.5, 1, {0, 1, 0}}, {-0.25, 0.5, {1, 0, 0}}};
  layer.clips = {{ClipPlane{{0, 0, 0.1}, {0, 0, -1}}}};
  expect_near(pixel(seen(layer)), {0.5, 0, 0, 0.5}, 1e-7);
}

TEST(Light, RefusesWhatItCannotMean) {
  const auto refused = [](const auto& change) {
    Scene scene = seen(Ramp{}.layer(1));
    change(scene.layers[0], scene);
    EXPECT_THROW(render(scene), Error);
  };
  refused([](Layer& layer, Scene&) { layer.shading = Shading{-0.1}; });
  refused([](Layer& layer, Scene&) { layer.shading = Shading{0.1, 0.1, 0.1, 0.5}; });
  refused([](Layer& layer, Scene&) {
    layer.shading = Shading{};
    layer.shading->channel = 1;
  });
  refused([](Layer& layer, Scene&) { layer.isosurfaces = {{1}, {1}}; });
  refused([](Layer& layer, Scene&) { layer.isosurfaces = {{1, 1.5}}; });
  refused([](Layer& layer, Scene&) { layer.slices = {{{}, {0, 0, 0}}}; });
  refused([](Layer& layer, Scene&) {
    layer.shading = Shading{};
    layer.projection = LayerProjection::maximum;
  });
  refused([](Layer&, Scene& scene) { scene.lights = {{DirectionalLight{{0, 0, 0}}}}; });
  EXPECT_THROW(GradientOpacity({{-1, 1}}), Error);
}

/// Red by one variable, opacity by another, both constant along the ray: a homogeneous slab.
Layer of_two_variables(double color, double opacity) {
  const auto constant = [](double value) {
    return scenes::sampled(
        {4, 4, 4}, [=](double, double, double) { return value; }, "constant");
  };
  return {ChannelsContent{
      std::make_shared<const Channels>(
          std::vector<Channel>{{"color", "", constant(color)}, {"opacity", "", constant(opacity)}}),
      std::make_shared<const MultivariateTransferFunction>(
          2, std::vector<GaussianPrimitive>(),
          std::vector<ChannelTransferFunction>{
              {0, TransferFunction({{0, 1, {0, 0, 1}}, {10, 1, {1, 0, 0}}})}},
          ChannelTransferFunction{1, TransferFunction({{-8, 0, {}}, {8, 2, {}}})})}};
}

TEST(Light, AFactorGivesOneVariableTheOpacityAndAnotherTheColor) {
  for (const double opacity : {-9.0, -8.0, -4.0, 0.0, 4.0, 20.0}) {
    const double depth = 2 * std::clamp((opacity + 8) / 8, 0.0, 2.0), alpha = -std::expm1(-depth);
    expect_near(pixel(seen(of_two_variables(2.5, opacity))), {0.25 * alpha, 0, 0.75 * alpha, alpha},
                1e-7);
  }
}

/// Panels take the argument of a factor for a magnitude, whose errors grow with it.
TEST(Light, AFactorOfNegativeValuesHasArgumentsNoSmallerThanThose) {
  for (const double value : {-4.0, 4.0}) {
    const Layer layer = of_two_variables(2, value);
    const LayerAppearance look(layer);
    const PiecewiseLinear<double> function = extinction_factor_of(layer)->function.view<double>();
    for (const double v : {-4.0, -3.5, 0.25, 4.0}) {
      if (v < value) continue;
      const double argument = look.factor_argument({{v, v, v, v}}).b[2];
      EXPECT_GE(argument, value < 0 ? 4 : v);
      EXPECT_DOUBLE_EQ(look.extinction_factor()->evaluate(argument).extinction,
                       function.evaluate(v).extinction);
    }
  }
}

TEST(Light, AFactorIsRefusedWhereItHasNoMeaning) {
  Scene scene = seen(of_two_variables(2, 1));
  scene.layers[0].gradient_opacity =
      std::make_shared<const GradientOpacity>(std::vector<GradientOpacity::Point>{{0, 1}});
  EXPECT_THROW(render(scene), Error);
  scene = seen(of_two_variables(2, 1));
  EXPECT_NO_THROW(render(scene));
}

}  // namespace
}  // namespace pellucid::test_light
