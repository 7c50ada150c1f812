// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>

#include "pellucid/reference/render.h"
#include "tests/scenes/makers.h"
#include "tests/scenes/meshes.h"

namespace pellucid::test_layers {
namespace {

using scenes::transfer;

/// A box from `lower`, of so many cells of length 1, with one extinction and color.
Layer constant_box(std::array<int, 3> cells, Vec3<double> lower, double extinction,
                   Rgb<double> color) {
  const auto volume = scenes::make_volume<float>(
      scenes::grid_description({cells[0] + 1, cells[1] + 1, cells[2] + 1}, lower),
      [](int, int, int) { return 1; });
  return {VolumeContent{volume, transfer({{0, extinction, color}})}};
}

/// Labels f(i, j, k) at whole places.
template <class Label>
std::shared_ptr<const LabelVolume> labels_of(std::array<int, 3> n, Label&& f,
                                             Centering centering = Centering::point) {
  Volume::Description description = scenes::grid_description(n);
  description.centering = centering;
  return std::make_shared<const LabelVolume>(
      scenes::make_volume<std::uint8_t>(description, std::forward<Label>(f)));
}

Scene of(std::vector<Layer> layers, std::vector<Clip> clips = {}) {
  Scene scene;
  scene.layers = std::move(layers);
  scene.clips = std::move(clips);
  return scene;
}

ReferencePixel along(const Scene& scene, Vec3<double> origin, Vec3<double> direction) {
  return reference_ray(scene, origin, direction);
}

/// From z = -10 upwards.
ReferencePixel upwards(const Scene& scene, double x, double y) {
  return along(scene, {x, y, -10}, {0, 0, 1});
}

void expect_depth(const ReferencePixel& pixel, double depth) {
  EXPECT_NEAR(pixel.optical_depth, depth, 1e-12 * (1 + depth));
  EXPECT_NEAR(pixel.opacity, -std::expm1(-depth), 1e-12);
}

/// The medium 0.3 of (1, 0, 0) on [0, 4], of 0.5 of (0, 1, 0) on [2, 6]: a mixture on [2, 4].
TEST(ReferenceLayers, OverlapIsASum) {
  const Layer first = constant_box({4, 4, 4}, {0, 0, 0}, 0.3, {1, 0, 0});
  const Layer second = constant_box({4, 4, 4}, {0, 0, 2}, 0.5, {0, 1, 0});
  const double front = 1 - std::exp(-0.6), middle = std::exp(-0.6) * (1 - std::exp(-1.6)),
               back = std::exp(-2.2) * (1 - std::exp(-1.0));
  for (const Scene& scene : {of({first, second}), of({second, first})}) {
    const ReferencePixel pixel = upwards(scene, 1.3, 2.1);
    expect_depth(pixel, 3.2);
    EXPECT_NEAR(pixel.radiance.r, front + middle * 0.3 / 0.8, 1e-12);
    EXPECT_NEAR(pixel.radiance.g, middle * 0.5 / 0.8 + back, 1e-12);
    EXPECT_NEAR(pixel.radiance.b, 0, 1e-15);
  }
}

TEST(ReferenceLayers, HiddenOnesAreNotThere) {
  Layer first = constant_box({4, 4, 4}, {0, 0, 0}, 0.3, {1, 0, 0});
  Layer second = constant_box({4, 4, 4}, {0, 0, 2}, 0.5, {0, 1, 0});
  second.visible = false;
  expect_depth(upwards(of({first, second}), 1, 1), 1.2);
  first.visible = false;
  EXPECT_EQ(upwards(of({first, second}), 1, 1).opacity, 0);
}

TEST(ReferenceLayers, PlanesCutExactly) {
  const Layer box = constant_box({4, 4, 4}, {0, 0, 0}, 0.7, {1, 1, 1});
  // z > 1 + (x - 2) / 2.
  const Clip plane{ClipPlane{{2, 0, 1}, {-1, 0, 2}}};
  Clip other = plane;
  other.keep_inside = false;
  for (const double x : {0.5, 1.7, 3.9}) {
    const double cut = 1 + (x - 2) / 2;
    expect_depth(upwards(of({box}, {plane}), x, 1), 0.7 * (4 - cut));
    expect_depth(upwards(of({box}, {other}), x, 1), 0.7 * cut);
    Layer kept = box, away = box;
    kept.clips = {plane};
    away.clips = {other};
    const Scene both = of({kept, away});
    expect_depth(upwards(both, x, 1), 2.8);
    EXPECT_NEAR(upwards(both, x, 1).radiance.g, 1 - std::exp(-2.8), 1e-12);
  }
}

TEST(ReferenceLayers, BoxesSpheresAndCylindersAreChords) {
  const Layer medium = constant_box({10, 10, 10}, {0, 0, 0}, 0.25, {1, 1, 1});
  const auto depth = [&](Clip clip, bool inside, double x, double y) {
    clip.keep_inside = inside;
    return upwards(of({medium}, {clip}), x, y).optical_depth / 0.25;
  };
  const Clip box{ClipBox{{1, 2, 3}, {5, 6, 8}}};
  EXPECT_NEAR(depth(box, true, 2, 3), 5, 1e-12);
  EXPECT_NEAR(depth(box, false, 2, 3), 5, 1e-12);
  EXPECT_NEAR(depth(box, true, 0.5, 3), 0, 1e-12);
  EXPECT_NEAR(depth(box, false, 0.5, 3), 10, 1e-12);
  const Clip sphere{ClipSphere{{5, 5, 4}, 3}};
  const double chord = 2 * std::sqrt(9 - 0.3 * 0.3 - 1.1 * 1.1);
  EXPECT_NEAR(depth(sphere, true, 5.3, 6.1), chord, 1e-12);
  EXPECT_NEAR(depth(sphere, false, 5.3, 6.1), 10 - chord, 1e-12);
  EXPECT_NEAR(depth(sphere, false, 8.1, 5), 10, 1e-12);
  // Across its axis, and along.
  const Clip across{ClipCylinder{{2, 5, 5}, {7, 5, 5}, 2}};
  EXPECT_NEAR(depth(across, true, 3, 6.2), 2 * std::sqrt(4 - 1.44), 1e-12);
  EXPECT_NEAR(depth(across, true, 7.1, 5), 0, 1e-12);
  const Clip upright{ClipCylinder{{5, 5, 2}, {5, 5, 6.5}, 2}};
  EXPECT_NEAR(depth(upright, true, 5.5, 5.5), 4.5, 1e-12);
  EXPECT_NEAR(depth(upright, false, 5.5, 5.5), 5.5, 1e-12);
  EXPECT_NEAR(depth(upright, true, 7.1, 5), 0, 1e-12);
}

TEST(ReferenceLayers, LabelsAreTheNearestValue) {
  const auto table = std::make_shared<const LabelTable>(std::vector<LabelStyle>{
      {1, "one", {1, 0, 0}, 0.2}, {2, "two", {0, 1, 0}, 9}, {3, "three", {0, 0, 1}, 0.6}});
  // 1, 1, 0, 3, 3, 3 along z: half a cell at either end, and no 2 between 1 and 3.
  const std::array<int, 6> column{1, 1, 0, 3, 3, 3};
  const auto label = [&](int, int, int k) { return column[static_cast<std::size_t>(k)]; };
  const ReferencePixel points =
      upwards(of({{LabelContent{labels_of({3, 3, 6}, label), table}}}), 1.2, 0.4);
  expect_depth(points, 0.2 * 1.5 + 0.6 * 2.5);
  EXPECT_NEAR(points.radiance.r, 1 - std::exp(-0.3), 1e-12);
  EXPECT_EQ(points.radiance.g, 0);
  EXPECT_NEAR(points.radiance.b, std::exp(-0.3) * (1 - std::exp(-1.5)), 1e-12);
  expect_depth(
      upwards(of({{LabelContent{labels_of({3, 3, 6}, label, Centering::cell), table}}}), -0.4, 0.4),
      0.2 * 2 + 0.6 * 3);
}

TEST(ReferenceLayers, MasksChooseTheFunction) {
  const auto data = scenes::make_volume<float>(scenes::grid_description({3, 3, 6}),
                                               [](int, int, int) { return 1; });
  const auto label = [](int, int, int k) { return k < 2 ? 0 : k < 4 ? 7 : 8; };
  const auto mask = std::make_shared<const LabelMask>(
      labels_of({3, 3, 6}, label),
      std::vector<LabelMask::Choice>{{7, transfer({{0, 0.9, {0, 1, 0}}})},
                                     {8, transfer({{0, 0, {0, 0, 0}}})}});
  const Scene scene = of({{VolumeContent{data, transfer({{0, 0.4, {1, 0, 0}}}), mask}}});
  const ReferencePixel pixel = upwards(scene, 1.4, 1.6);
  expect_depth(pixel, 0.4 * 1.5 + 0.9 * 2);
  EXPECT_NEAR(pixel.radiance.r, 1 - std::exp(-0.6), 1e-12);
}

TEST(ReferenceLayers, TransformsMoveTheData) {
  const auto volume = scenes::builtin("hydrogen", 9);
  const auto function = transfer({{0.05, 0, {1, 0, 0}}, {0.6, 2, {0, 1, 1}}});
  Affine<double> map;
  map.matrix = {{{0.8, 0.5, 0}, {-0.4, 0.9, 0.2}, {0.1, 0, 1.3}}};
  map.translation = {3, -2, 5};
  Layer layer{VolumeContent{volume, function}};
  const Scene here = of({layer});
  layer.transform = map;
  const Scene there = of({layer});
  for (int i = 0; i < 20; ++i) {
    const Vec3<double> from{-3.0 + 0.2 * i, 2, 1.0 - 0.1 * i}, to{0.1 * i - 1, 0.05 * i - 0.5, 0.3};
    const Vec3<double> moved = map.vector(to - from);
    const ReferencePixel first = along(here, from, to - from),
                         second = along(there, map.point(from), moved);
    // Lengths change by one factor all along the ray.
    EXPECT_NEAR(second.optical_depth, first.optical_depth * length(moved) / length(to - from),
                1e-11);
  }
}

TEST(ReferenceLayers, AMeshInAGridIsASumToo) {
  const auto mesh = scenes::make_mesh(scenes::box_of_cubes(3));
  const auto field = scenes::on_mesh(
      mesh, {scenes::at_points(*mesh, "one", [](const Vec3<double>&) { return 1.0; })});
  const Layer cube{MeshContent{field, transfer({{0, 0.8, {0, 0, 1}}})}};
  const Layer medium = constant_box({4, 4, 4}, {-2, -2, -2}, 0.3, {1, 0, 0});
  const ReferencePixel pixel = upwards(of({medium, cube}), 0.21, -0.34);
  const Box<double>& box = mesh->bounds();
  expect_depth(pixel, 0.3 * 4 + 0.8 * (box.upper.z - box.lower.z));
}

}  // namespace
}  // namespace pellucid::test_layers
