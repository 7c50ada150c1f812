// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "multivariate.h"
#include "pellucid/reference/render.h"
#include "tests/scenes/makers.h"
#include "tests/scenes/meshes.h"

namespace pellucid::test_surfaces {
namespace {

using scenes::grid_description;
using scenes::make_volume;
using scenes::transfer;
using Place = Vec3<double>;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
const scenes::Points clear{{0, 0, {0, 0, 0}}};

Scene of(std::vector<Layer> layers) {
  Scene scene;
  scene.layers = std::move(layers);
  return scene;
}

Layer layer_of(scenes::VolumePointer volume, scenes::Points points = clear) {
  return {VolumeContent{std::move(volume), transfer(std::move(points))}};
}

/// z from 0 to 4 in a box of 4 × 4 × 4.
scenes::VolumePointer ramp() {
  return make_volume<float>(grid_description({5, 5, 5}), [](int, int, int k) { return k; });
}

/// Values along z, the same everywhere else.
scenes::VolumePointer column(const std::vector<double>& values) {
  return make_volume<double>(grid_description({3, 3, static_cast<int>(values.size())}),
                             [&](int, int, int k) { return values[static_cast<std::size_t>(k)]; });
}

Isosurface surface(double value, double opacity, Rgb<double> color = {1, 1, 1}) {
  return {value, opacity, color};
}

/// From z = -10 upwards; positions are 10 more than z.
ReferencePixel upwards(const Scene& scene, double x = 1.3, double y = 0.6) {
  return reference_ray(scene, {x, y, -10}, {0, 0, 1});
}

void expect_color(const Rgb<double>& color, const Rgb<double>& truth, double tolerance = 1e-12) {
  EXPECT_NEAR(color.r, truth.r, tolerance);
  EXPECT_NEAR(color.g, truth.g, tolerance);
  EXPECT_NEAR(color.b, truth.b, tolerance);
}

/// How many surfaces of opacity 1/2 there are on a ray.
double count(const ReferencePixel& pixel) {
  return pixel.optical_depth / std::log(2.0);
}

TEST(ReferenceSurfaces, LieOverTheMediumBehind) {
  Layer layer = layer_of(ramp(), {{0, 0.3, {1, 0, 0}}});
  layer.isosurfaces = {surface(2.5, 0.5, {0, 1, 0.25})};
  const ReferencePixel pixel = upwards(of({layer}));
  const double front = std::exp(-0.75), back = 0.5 * front * (1 - std::exp(-0.45));
  expect_color(pixel.radiance, {1 - front + back, 0.5 * front, 0.125 * front});
  EXPECT_NEAR(pixel.opacity, 1 - 0.5 * std::exp(-1.2), 1e-13);
  EXPECT_NEAR(pixel.optical_depth, 1.2 + std::log(2), 1e-13);
  // 0.528 in front of the surface, 0.764 behind it, 0.425 wanted.
  EXPECT_NEAR(pixel.half_opacity_depth, 10 - std::log1p(-0.5 * pixel.opacity) / 0.3, 1e-10);

  // At a surface that passes half of the opacity.
  layer.isosurfaces = {surface(1.5, 0.9)};
  EXPECT_NEAR(upwards(of({layer})).half_opacity_depth, 11.5, 1e-15);
  // Behind it.
  layer.isosurfaces = {surface(0.5, 0.1)};
  const ReferencePixel late = upwards(of({layer}));
  EXPECT_NEAR(late.half_opacity_depth,
              10 + (std::log1p(-0.1) - std::log1p(-0.5 * late.opacity)) / 0.3, 1e-10);
  // Obliquely: z = 2.5 at 12.5 √2.
  layer.isosurfaces = {surface(2.5, 1)};
  layer.content = VolumeContent{ramp(), transfer(clear)};
  EXPECT_NEAR(reference_ray(of({layer}), {0, 1.7, -10 + 9}, {1, 0, 1}).half_opacity_depth,
              3.5 * std::sqrt(2), 1e-14);
}

TEST(ReferenceSurfaces, OpaqueOnesEndTheRay) {
  Layer layer = layer_of(ramp(), {{0, 0.3, {1, 0, 0}}});
  layer.isosurfaces = {surface(3, 1, {0, 0, 1}), surface(1, 1, {0, 1, 0})};
  const ReferencePixel pixel = upwards(of({layer}));
  const double front = std::exp(-0.3);
  expect_color(pixel.radiance, {1 - front, front, 0});
  EXPECT_EQ(pixel.opacity, 1);
  EXPECT_EQ(pixel.optical_depth, infinity);
  EXPECT_NEAR(pixel.half_opacity_depth, 11, 1e-15);
}

TEST(ReferenceSurfaces, NestFromFrontToBack) {
  Layer layer = layer_of(column({0, 1, 2, 3, 2, 1, 0}));
  const double a = 0.2, b = 0.3;
  layer.isosurfaces = {surface(2.25, b, {0, 1, 0}), surface(0.5, a, {1, 0, 0})};
  const ReferencePixel pixel = upwards(of({layer}));
  expect_color(pixel.radiance, {a * (1 + (1 - a) * (1 - b) * (1 - b)), (1 - a) * b * (2 - b), 0});
  EXPECT_NEAR(pixel.opacity, 1 - std::pow((1 - a) * (1 - b), 2), 1e-14);
}

TEST(ReferenceSurfaces, TouchesAreNone) {
  const auto crossings = [](const std::vector<double>& values, double value) {
    Layer layer = layer_of(column(values));
    layer.isosurfaces = {surface(value, 0.5)};
    return upwards(of({layer}));
  };
  EXPECT_EQ(count(crossings({0, 1, 2, 3, 2, 1, 0}, 3)), 0);
  EXPECT_EQ(count(crossings({3, 2, 1, 2, 3}, 1)), 0);
  EXPECT_NEAR(count(crossings({0, 1, 2, 3, 2, 1, 0}, 2)), 2, 1e-14);
  // A plateau at the value, with a change and without; at the border; all of it.
  EXPECT_NEAR(count(crossings({0, 1, 1, 1, 2}, 1)), 1, 1e-14);
  EXPECT_NEAR(crossings({0, 1, 1, 1, 2}, 1).half_opacity_depth, 13, 1e-14);
  EXPECT_EQ(count(crossings({0, 1, 1, 1, 0}, 1)), 0);
  EXPECT_EQ(count(crossings({0, 1, 2, 3}, 3)), 0);
  EXPECT_EQ(count(crossings({0, 1, 2, 3}, 0)), 0);
  EXPECT_EQ(count(crossings({1, 1, 1, 1}, 1)), 0);

  // f = x (1 - y) in a cell; s (1 - s) along its diagonal.
  Layer saddle = layer_of(make_volume<float>(grid_description({2, 2, 2}),
                                             [](int i, int j, int) { return i * (1 - j); }));
  for (const auto& [value, number] : {std::pair{0.25, 0}, {0.2499, 2}, {0.2501, 0}}) {
    saddle.isosurfaces = {surface(value, 0.5)};
    EXPECT_NEAR(count(reference_ray(of({saddle}), {-1, -1, 0.4}, {1, 1, 0})), number, 1e-14);
  }
  // s (1 - s) = 0.21 at 0.3 and 0.7.
  saddle.isosurfaces = {surface(0.21, 1)};
  EXPECT_NEAR(reference_ray(of({saddle}), {-1, -1, 0.4}, {1, 1, 0}).half_opacity_depth,
              1.3 * std::sqrt(2), 1e-15);
}

/// Through faces, edges and corners, and from any side.
TEST(ReferenceSurfaces, CrossingsBetweenCellsCountOnce) {
  const auto volume = make_volume<double>(
      grid_description({6, 6, 6}), [](int i, int j, int k) { return 0.1 * (i + 2 * j + 4 * k); });
  Layer layer = layer_of(volume);
  const Place centre{3, 2, 2};
  layer.isosurfaces = {surface(0.1 * (3 + 2 * 2 + 4 * 2), 0.5)};
  for (int dx = -3; dx <= 3; ++dx) {
    for (int dy = -3; dy <= 3; ++dy) {
      for (int dz = -3; dz <= 3; ++dz) {
        if (dx + 2 * dy + 4 * dz == 0) continue;
        const Place direction{1.0 * dx, 1.0 * dy, 1.0 * dz};
        const ReferencePixel pixel = reference_ray(of({layer}), centre - direction * 7, direction);
        EXPECT_NEAR(count(pixel), 1, 1e-14) << dx << ' ' << dy << ' ' << dz;
        EXPECT_NEAR(pixel.half_opacity_depth, 7 * length(direction), 1e-13);
      }
    }
  }
}

TEST(ReferenceSurfaces, DataThatAreNotThereHaveNone) {
  // Between 0 and 4 there is vacuum; so is what clips cut away.
  Layer gap = layer_of(column({0, 0.5, nan, 3.5, 4}));
  gap.isosurfaces = {surface(2, 0.5)};
  EXPECT_EQ(upwards(of({gap})).opacity, 0);
  Layer cut = layer_of(ramp());
  cut.isosurfaces = {surface(2, 0.5)};
  cut.clips = {{ClipBox{{-1, -1, 1.5}, {5, 5, 2.5}}, false}};
  EXPECT_EQ(upwards(of({cut})).opacity, 0);
  cut.clips.front().keep_inside = true;
  EXPECT_NEAR(count(upwards(of({cut}))), 1, 1e-14);
  // A ray that begins behind it, and one that ends in front.
  cut.clips.clear();
  EXPECT_EQ(reference_ray(of({cut}), {1, 1, 2.1}, {0, 0, 1}).opacity, 0);
  Scene scene = of({cut});
  scene.backdrop = std::make_shared<const Image>();
  EXPECT_EQ(ReferenceRays(scene)({1, 1, -1}, {0, 0, 1}, 2.9).opacity, 0);
  EXPECT_NEAR(ReferenceRays(scene)({1, 1, -1}, {0, 0, 1}, 3.1).opacity, 0.5, 1e-15);
}

TEST(ReferenceSurfaces, ColorsAreOfAnotherChannel) {
  const auto channels = std::make_shared<const Channels>(test::make_channels(
      grid_description({5, 5, 5}),
      {[](int, int, int k) { return 1.0 * k; }, [](int i, int, int k) { return 10.0 * i + k; }}));
  Layer layer{ChannelsContent{channels, std::make_shared<const MultivariateTransferFunction>(
                                            2, std::vector<GaussianPrimitive>{test::make_gaussian(
                                                   {0, 0}, {1, 1}, 0, {0, 0, 0})})}};
  Isosurface painted = surface(2.5, 0.5);
  painted.colors = transfer({{10, 0, {0, 0, 1}}, {20, 0, {1, 0, 0}}, {20, 0, {0, 1, 0}}});
  painted.color_channel = 1;
  layer.isosurfaces = {painted};
  expect_color(upwards(of({layer}), 1.3).radiance, {0.5 * 0.55, 0, 0.5 * 0.45});
  expect_color(upwards(of({layer}), 0.3).radiance, {0, 0, 0.5});
  expect_color(upwards(of({layer}), 3.3).radiance, {0, 0.5, 0});
}

/// v = z² sampled has the slope 2z at whole z within: v = 5 at z = 2.2 on the chord of 4 and 9.
TEST(ReferenceSurfaces, AreShadedByTheGradientThere) {
  const auto volume = make_volume<float>(grid_description({9, 9, 7}),
                                         [](int i, int, int k) { return k * k + 3 * i; });
  Layer layer = layer_of(volume);
  layer.isosurfaces = {surface(5 + 9, 0.5, {1, 0.5, 0})};
  layer.shading = Shading{0.1, 0.6, 0.3, 5, GradientKind::smooth, 0.02};
  const double flat = 0.02 * (36 + 24);
  const auto expect = [&](const ReferencePixel& pixel, double slope) {
    const double cosine = slope / std::sqrt(slope * slope + 9 + flat * flat);
    const double by = 0.1 + 0.6 * cosine, added = 0.3 * std::pow(cosine, 5);
    expect_color(pixel.radiance, {0.5 * (by + added), 0.5 * (0.5 * by + added), 0.5 * added});
    EXPECT_NEAR(pixel.half_opacity_depth, 12.2, 1e-14);
  };
  expect(upwards(of({layer}), 3), 2 * 2.2);
  layer.shading->gradient = GradientKind::field;
  expect(upwards(of({layer}), 3), 5);
  // Both sides are alike, and the medium does not matter.
  layer.content = VolumeContent{volume, transfer({{0, 0, {0, 0, 0}}, {100, 0, {0, 0, 0}}})};
  const ReferencePixel pixel = reference_ray(of({layer}), {3, 0.6, 14.4}, {0, 0, -1});
  expect(pixel, 5);
}

TEST(ReferenceSurfaces, SlicesShowTheData) {
  Layer layer = layer_of(ramp(), {{0, 0.3, {1, 0, 0}}, {4, 0.3, {0, 1, 0}}});
  layer.shading = Shading{1, 0, 0, 1};
  Slice slice{{0, 0, 1}, {0, 0, 2}, 0.4};
  layer.slices = {slice};
  const ReferencePixel pixel = upwards(of({layer}));
  EXPECT_NEAR(pixel.optical_depth, 1.2 - std::log1p(-0.4), 1e-13);
  Layer without = layer;
  without.slices.clear();
  const ReferencePixel medium = upwards(of({without}));
  // The medium alone, of which the part behind is dimmed.
  Layer front = without;
  front.clips = {{ClipBox{{-1, -1, -1}, {9, 9, 1}}}};
  const double red = upwards(of({front})).radiance.r;
  const double through = std::exp(-0.3);
  EXPECT_NEAR(pixel.radiance.r, red + 0.6 * (medium.radiance.r - red) + through * 0.4 * 0.75,
              1e-12);

  // A table of its own; not lit.
  Layer alone = layer_of(ramp());
  alone.shading = Shading{0.1, 0.2, 0.3, 1};
  slice.colors = transfer({{0, 0, {0, 0, 0}}, {2, 9, {1, 2, 4}}});
  alone.slices = {slice};
  expect_color(upwards(of({alone})).radiance, {0.2, 0.4, 0.8});
  EXPECT_NEAR(upwards(of({alone})).half_opacity_depth, 11, 1e-15);
  // Obliquely, in the world of a layer that is moved.
  alone.transform.translation = {0, 0, 0.5};
  alone.slices[0].normal = {1, 0, 1};
  const ReferencePixel oblique = upwards(of({alone}), 0.25);  // z = 0.75, v = 0.25
  expect_color(oblique.radiance, {0.05, 0.1, 0.2});
  EXPECT_NEAR(oblique.half_opacity_depth, 10.75, 1e-14);
}

TEST(ReferenceSurfaces, SlicesAreWhereDataAre) {
  const auto opacity = [](const Layer& layer, const Place& from, const Place& direction) {
    return reference_ray(of({layer}), from, direction).opacity;
  };
  Layer layer = layer_of(ramp(), {{0, 0, {1, 0, 0}}});
  const Place oblique{0.1, 0.07, 1.0 / 3};
  // At both borders, however oblique the ray; not beyond.
  for (const double z : {0.0, 4.0}) {
    layer.slices = {{{7, -3, z}, {0, 0, -0.3}, 0.25}};
    for (int i = 0; i < 20; ++i) {
      const Place direction = oblique + Place{0.01 * i, 0, 0};
      const Place aim{1.1 + 0.03 * i, 1.9, z};
      EXPECT_NEAR(opacity(layer, aim - direction * 17.3, direction), 0.25, 1e-15);
    }
  }
  for (const double z : {-1e-9, 4 + 1e-9}) {
    layer.slices = {{{0, 0, z}, {0, 0, 1}, 0.25}};
    EXPECT_EQ(opacity(layer, {1, 1, -3}, {0, 0, 1}), 0);
  }
  // At clips; not where they cut; not in a parallel ray, nor behind its origin.
  layer.slices = {{{0, 0, 2}, {0, 0, 1}, 0.25}};
  layer.clips = {{ClipPlane{{0, 0, 2}, {0, 0, 3}}}};
  EXPECT_NEAR(opacity(layer, {1, 1, -3}, {0.1, 0.1, 1}), 0.25, 1e-15);
  layer.clips = {{ClipPlane{{0, 0, 2.01}, {0, 0, 3}}}};
  EXPECT_EQ(opacity(layer, {1, 1, -3}, {0.1, 0.1, 1}), 0);
  layer.clips.clear();
  EXPECT_EQ(opacity(layer, {-1, 1, 2}, {1, 0.1, 0}), 0);
  EXPECT_EQ(opacity(layer, {1, 1, 2.5}, {0, 0, 1}), 0);
  EXPECT_NEAR(opacity(layer, {1, 1, 2.5}, {0, 0, -1}), 0.25, 1e-15);
  // Not in vacuum, but at its border.
  Layer gap = layer_of(column({0, 1, nan, 3, 4, 5}), {{0, 0, {1, 0, 0}}});
  for (const auto& [z, expected] :
       {std::pair{0.5, 0.25}, {1.0, 0.25}, {1.5, 0.0}, {2.5, 0.0}, {3.0, 0.25}}) {
    gap.slices = {{{0, 0, z}, {0, 0, 1}, 0.25}};
    EXPECT_NEAR(opacity(gap, {1, 1, -3}, {0.01, 0.02, 1}), expected, 1e-15) << z;
  }
}

TEST(ReferenceSurfaces, MasksChooseTheSlicesColors) {
  const auto labels = std::make_shared<const LabelVolume>(make_volume<std::uint8_t>(
      grid_description({5, 5, 5}), [](int i, int, int) { return i < 2 ? 0 : 7; }));
  const auto mask = std::make_shared<const LabelMask>(
      labels,
      std::vector<LabelMask::Choice>{{7, transfer({{0, 0, {0, 0, 0}}, {4, 0, {0, 1, 0}}})}});
  Layer layer{VolumeContent{ramp(), transfer({{0, 0, {1, 0, 0}}}), mask}};
  layer.slices = {{{0, 0, 2}, {0, 0, 1}, 0.5}};
  layer.isosurfaces = {surface(3, 0.5, {0, 0, 1})};
  expect_color(upwards(of({layer}), 1.4).radiance, {0.5, 0, 0.25});
  expect_color(upwards(of({layer}), 1.6).radiance, {0, 0.25, 0.25});
  // Along x the surface of a mask's border is none; labels do not cut what is continuous.
  Layer across = layer;
  across.slices.clear();
  across.content = VolumeContent{
      make_volume<float>(grid_description({5, 5, 5}), [](int i, int, int) { return i; }),
      transfer(clear), mask};
  for (const double value : {1.5, 1.25, 2.0}) {
    across.isosurfaces = {surface(value, 0.5)};
    EXPECT_NEAR(count(reference_ray(of({across}), {-1, 1, 1}, {1, 0, 0})), 1, 1e-14);
  }
}

TEST(ReferenceSurfaces, CoincidentOnesAreAMixture) {
  Layer first = layer_of(ramp(), {{0, 0, {0, 1, 0}}});
  first.slices = {{{0, 0, 2.3}, {0, 0, 1}, 0.6}};
  Layer second = layer_of(
      make_volume<double>(grid_description({5, 5, 5}), [](int, int, int k) { return 0.7 * k; }));
  second.isosurfaces = {surface(0.7 * 2.3, 0.2, {1, 0, 0})};
  const double d1 = -std::log1p(-0.6), d2 = -std::log1p(-0.2);
  for (const Scene& scene : {of({first, second}), of({second, first})}) {
    const ReferencePixel pixel = reference_ray(scene, {0.7, 1.1, -7}, {0.03, 0.04, 1});
    EXPECT_NEAR(pixel.opacity, 1 - 0.4 * 0.8, 1e-14);
    expect_color(pixel.radiance, {0.68 * d2 / (d1 + d2), 0.68 * d1 / (d1 + d2), 0});
  }
  first.slices[0].opacity = 1;
  Scene scene = of({second, first});
  expect_color(upwards(scene).radiance, {0, 1, 0});
  scene.layers[0].isosurfaces[0].opacity = 1;
  expect_color(upwards(scene).radiance, {0.5, 0.5, 0});
  // Next to each other they are in order.
  scene.layers[0].isosurfaces[0].value -= 1e-9;
  expect_color(upwards(scene).radiance, {1, 0, 0});
}

TEST(ReferenceSurfaces, CutTetrahedra) {
  const auto mesh = scenes::make_mesh(scenes::box_of_cubes(4));
  const Place g{0.3, -0.2, 1};
  Layer layer{MeshContent{
      scenes::on_mesh(
          mesh, {scenes::at_points(*mesh, "ramp", [&](const Place& p) { return dot(g, p); })}),
      transfer({{-9, 0.4, {1, 0, 0}}})}};
  layer.isosurfaces = {surface(0.1, 0.5, {0, 1, 0})};
  layer.shading = Shading{0.2, 0.7, 0, 1, GradientKind::smooth, 0};
  const double shade = 0.2 + 0.7 * 1 / length(g);
  // In the middle of tetrahedra, and along their edges and through their points.
  for (const auto& [x, y] : {std::pair{0.13, -0.38}, {0.0, 0.0}, {0.5, -0.5}, {0.25, 0.25}}) {
    const ReferencePixel pixel = upwards(of({layer}), x, y);
    const double z = 0.1 - g.x * x - g.y * y;
    const double front = std::exp(-0.4 * (z + 1)), back = std::exp(-0.4 * (1 - z));
    EXPECT_NEAR(pixel.opacity, 1 - 0.5 * front * back, 1e-13);
    EXPECT_NEAR(pixel.radiance.g, 0.5 * front * shade, 1e-13);
    EXPECT_NEAR(pixel.radiance.r, shade * (1 - front + 0.5 * front * (1 - back)), 1e-12);
  }
  // At a value that points have: z = 0.5 is a face of the cubes.
  layer.content = MeshContent{
      scenes::on_mesh(mesh, {scenes::at_points(*mesh, "z", [](const Place& p) { return p.z; })}),
      transfer(clear)};
  layer.isosurfaces = {surface(0.5, 0.5)};
  for (const auto& [x, y] : {std::pair{0.13, -0.38}, {0.0, 0.0}, {0.5, -0.5}, {0.25, 0.25}}) {
    EXPECT_NEAR(count(upwards(of({layer}), x, y)), 1, 1e-14);
    EXPECT_NEAR(upwards(of({layer}), x, y).half_opacity_depth, 10.5, 1e-14);
  }
  // Values per tetrahedron jump over the surface's.
  layer.content = MeshContent{
      scenes::on_mesh(mesh, {scenes::at_cells(
                                *mesh, "z", [](const Place& p) { return p.z > 0.5 ? 1.0 : 0.0; })}),
      transfer(clear)};
  EXPECT_NEAR(count(upwards(of({layer}), 0.13, -0.38)), 1, 1e-14);
  EXPECT_NEAR(upwards(of({layer}), 0.13, -0.38).half_opacity_depth, 10.5, 1e-14);
}

}  // namespace
}  // namespace pellucid::test_surfaces
