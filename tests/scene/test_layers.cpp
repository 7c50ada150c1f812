// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "pellucid/scene/defaults.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/scene.h"

namespace pellucid::test_layers {
namespace {

template <class Body>
std::string error_of(Body&& body) {
  try {
    body();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

void expect_part(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "\"" << text << "\" has no \"" << part << "\"";
}

std::shared_ptr<const Volume> volume_of(std::vector<float> values, std::array<int, 3> n) {
  Volume::Description description;
  description.dimensions = n;
  description.name = "small";
  return std::make_shared<const Volume>(description, DataArray<float>(std::move(values)));
}

std::shared_ptr<const Volume> ramp() {
  return volume_of({0, 1, 2, 3, 4, 5, 6, 7}, {2, 2, 2});
}

std::shared_ptr<const TransferFunction> haze() {
  return std::make_shared<const TransferFunction>(
      std::vector<TransferFunction::Point>{{0, 1, {0.5, 0.25, 1}}});
}

Scene scene_of(Layer layer) {
  Scene scene;
  scene.layers = {std::move(layer)};
  return scene;
}

std::string error_of_layer(Layer layer) {
  return error_of([&] { check_data(scene_of(std::move(layer))); });
}

TEST(Layers, AreNeeded) {
  expect_part(error_of([] { check_data({}); }), "there is no layer; give at least one");
}

TEST(Layers, NeedDataAndAFunction) {
  expect_part(error_of_layer({VolumeContent{ramp(), nullptr}}), "scene: a volume and a transfer");
  expect_part(error_of_layer({VolumeContent{nullptr, haze()}}), "set both before rendering");
  expect_part(error_of_layer({ChannelsContent{}}), "channels and a multivariate function");
  expect_part(error_of_layer({MeshContent{}}), "a mesh and a transfer function");
  expect_part(error_of_layer({LabelContent{}}), "labels and a table of colors");
  EXPECT_EQ(error_of_layer({VolumeContent{ramp(), haze()}}), "");
  Layer second{VolumeContent{ramp(), nullptr}};
  second.name = "dose";
  Scene scene = scene_of({VolumeContent{ramp(), haze()}});
  scene.layers.push_back(second);
  expect_part(error_of([&] { check_data(scene); }), "layer \"dose\": ");
  scene.layers[1].name.clear();
  expect_part(error_of([&] { check_data(scene); }), "layer 2: ");
}

TEST(Layers, TransformsAreRegular) {
  Layer layer{VolumeContent{ramp(), haze()}};
  layer.transform.matrix.column[2] = layer.transform.matrix.column[0];
  expect_part(error_of_layer(layer), "transform is singular");
  layer.transform = {};
  layer.transform.translation.y = std::numeric_limits<double>::quiet_NaN();
  expect_part(error_of_layer(layer), "must be finite");
  layer.transform.translation.y = 0;
  EXPECT_TRUE(is_in_place(layer));
  // However small or large: units of length do not matter.
  for (const double scale : {1e-12, 1e12}) {
    layer.transform.matrix = {{{scale, 0, 0}, {0, scale, 0}, {0, 0, scale}}};
    EXPECT_EQ(error_of_layer(layer), "");
    EXPECT_FALSE(is_in_place(layer));
  }
}

TEST(Layers, ClipsAreShapes) {
  const auto error = [](Clip clip) {
    Layer layer{VolumeContent{ramp(), haze()}};
    layer.clips = {{ClipSphere{}}, std::move(clip)};
    return error_of_layer(layer);
  };
  constexpr double infinity = std::numeric_limits<double>::infinity();
  expect_part(error({ClipPlane{{0, 0, 0}, {0, 0, 0}}}), "clip 2: normal is (0, 0, 0)");
  expect_part(error({ClipPlane{{0, infinity, 0}, {0, 0, 1}}}), "point is (0, inf, 0)");
  expect_part(error({ClipBox{{0, 0, 0}, {1, -1, 1}}}), "is empty");
  expect_part(error({ClipSphere{{0, 0, 0}, 0}}), "radius is 0");
  expect_part(error({ClipSphere{{0, 0, 0}, infinity}}), "radius is inf");
  expect_part(error({ClipCylinder{{1, 1, 1}, {1, 1, 1}, 2}}), "end - start is (0, 0, 0)");
  Scene scene = scene_of({VolumeContent{ramp(), haze()}});
  scene.clips = {{ClipBox{{0, 0, 0}, {0, 1, 1}}}};
  expect_part(error_of([&] { check_data(scene); }), "scene: clip 1: box from");
}

TEST(Layers, MovedVolumesShareTheirData) {
  const auto volume = ramp();
  Affine<double> map;
  map.matrix = {{{0, 2, 0}, {-2, 0.5, 0}, {0, 0, 3}}};
  map.translation = {10, 20, 30};
  const Volume moved = volume->moved(map);
  EXPECT_EQ(std::get<DataArray<float>>(moved.data()).data(),
            std::get<DataArray<float>>(volume->data()).data());
  EXPECT_EQ(&moved.block_records()[0], &volume->block_records()[0]);
  const auto before = volume->world_corners(), after = moved.world_corners();
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(after[i], map.point(before[i]));
  EXPECT_DOUBLE_EQ(moved.voxel_size(), 2);
  map.matrix.column[2] = {0, 0, 0};
  expect_part(error_of([&] { volume->moved(map); }), "direction is singular");
}

TEST(Layers, MovedIntoPlaceIsWhereTheTransformSays) {
  Layer layer{VolumeContent{ramp(), haze()}};
  layer.transform.translation = {1, 2, 3};
  const Layer moved = moved_into_place(layer);
  EXPECT_TRUE(is_in_place(moved));
  EXPECT_EQ(world_corners(moved), world_corners(layer));

  TetrahedralMesh::Description description;
  description.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  description.tetrahedra = {{0, 1, 2, 3}};
  MeshChannel channel;
  channel.name = "a";
  channel.values = DataArray<float>({0, 1, 2, 3});
  Layer mesh{MeshContent{
      std::make_shared<const MeshChannels>(std::make_shared<const TetrahedralMesh>(description),
                                           std::vector<MeshChannel>{channel}),
      haze()}};
  // A mirror turns the tetrahedron's orientation.
  mesh.transform.matrix.column[0] = {-2, 0, 0};
  const Layer mirrored = moved_into_place(mesh);
  const auto& points = std::get<MeshContent>(mirrored.content).mesh->mesh().points();
  EXPECT_EQ(points[1], (Vec3<double>{-2, 0, 0}));
  EXPECT_EQ(points[3], (Vec3<double>{0, 0, 1}));
}

TEST(Layers, CornersEncloseWhatIsVisible) {
  Layer here{VolumeContent{ramp(), haze()}}, there = here;
  there.transform.translation = {5, -1, 0};
  Scene scene = scene_of(here);
  scene.layers.push_back(there);
  EXPECT_EQ(world_corners(scene)[0], (Vec3<double>{0, -1, 0}));
  EXPECT_EQ(world_corners(scene)[7], (Vec3<double>{6, 1, 1}));
  scene.layers[1].visible = false;
  EXPECT_EQ(world_corners(scene)[7], (Vec3<double>{1, 1, 1}));
  scene.layers[0].visible = false;  // then of all
  EXPECT_EQ(world_corners(scene)[7], (Vec3<double>{6, 1, 1}));
}

TEST(Labels, AreWholeNumbers) {
  const LabelVolume labels(volume_of({3, 0, 3, -1, 0, 0, 7, 3}, {2, 2, 2}));
  EXPECT_EQ(labels.labels(), (std::vector<std::int32_t>{-1, 0, 3, 7}));
  expect_part(error_of([] {
                LabelVolume(volume_of({0, 1, 2.5, 0, 0, 0, 0, 0}, {2, 2, 2}));
              }),
              "small: holds the value 2.5");
  expect_part(error_of([] {
                LabelVolume(volume_of({0, 1, 2e7, 0, 0, 0, 0, 0}, {2, 2, 2}));
              }),
              "holds the value 2e+07");
  expect_part(error_of([] { LabelVolume(nullptr); }), "there is no volume");
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(LabelVolume(volume_of({nan, 1, nan, nan, 1, 1, 1, 1}, {2, 2, 2})).labels().size(), 1U);
}

TEST(Labels, TablesAreTents) {
  const LabelTable table({{5, "b", {0, 1, 0}, 2}, {4, "a", {1, 0, 0}, 3}, {-2, "", {0, 0, 1}, 1}});
  EXPECT_EQ(table.styles().front().label, -2);
  const PiecewiseLinear<double> f = table.function().view<double>();
  EXPECT_EQ(f.evaluate(4).extinction, 3);
  EXPECT_EQ(f.evaluate(4).color, (Rgb<double>{1, 0, 0}));
  EXPECT_EQ(f.evaluate(5).extinction, 2);
  EXPECT_EQ(f.evaluate(5).color, (Rgb<double>{0, 1, 0}));
  EXPECT_EQ(f.evaluate(-2).extinction, 1);
  for (const double between : {-30.0, -2.5, -1.5, 0.0, 3.0, 3.5, 4.5, 5.5, 6.0, 9.0}) {
    EXPECT_EQ(f.evaluate(between).extinction, 0) << between;
  }
  expect_part(error_of([] { LabelTable({}); }), "no label has a color");
  expect_part(error_of([] { LabelTable({{1, "", {}, 1}, {1, "", {}, 2}}); }), "label 1: is there");
  expect_part(error_of([] { LabelTable({{1, "", {}, -1}}); }), "label 1: extinction is -1");
  expect_part(error_of([] { LabelTable({{1, "", {0, -2, 0}, 1}}); }), "label 1: color is -2");
}

TEST(Labels, HaveDefaultLooks) {
  const LabelVolume labels(volume_of({3, 0, 3, 1, 0, 0, 7, 3}, {2, 2, 2}));
  const LabelTable table = default_label_table(labels);
  ASSERT_EQ(table.styles().size(), 3U);
  for (const LabelStyle& style : table.styles()) EXPECT_GT(style.extinction, 0);
  EXPECT_NE(table.styles()[0].color, table.styles()[1].color);
  EXPECT_EQ(default_label_table(labels, 0.25).styles()[0].extinction, 0.25);
  const LabelVolume empty(volume_of(std::vector<float>(8, 0), {2, 2, 2}));
  EXPECT_EQ(default_label_table(empty).styles().front().label, 0);
}

TEST(Labels, ThatFollowEachOtherAreToldApart) {
  std::vector<int> values;
  for (int i = 0; i < 125; ++i) values.push_back(std::min(i, 116));
  for (const int labels : {3, 7, 12, 116}) {
    std::vector<float> few;
    for (const int v : values) few.push_back(static_cast<float>(std::min(v, labels)));
    const LabelTable table = default_label_table(LabelVolume(volume_of(few, {5, 5, 5})));
    ASSERT_EQ(table.styles().size(), static_cast<std::size_t>(labels));
    for (std::size_t i = 1; i < table.styles().size(); ++i) {
      const Rgb<double> apart = table.styles()[i].color + table.styles()[i - 1].color * -1;
      EXPECT_GT(std::max({std::abs(apart.r), std::abs(apart.g), std::abs(apart.b)}), 0.25)
          << labels << ", " << i;
    }
  }
}

TEST(Labels, MasksAreOnTheGridOfTheData) {
  const auto labels = std::make_shared<const LabelVolume>(ramp());
  const auto mask =
      std::make_shared<const LabelMask>(labels, std::vector<LabelMask::Choice>{{3, haze()}});
  EXPECT_EQ(mask->choice_of(3), 0);
  EXPECT_EQ(mask->choice_of(4), -1);
  EXPECT_EQ(error_of_layer({VolumeContent{ramp(), haze(), mask}}), "");
  expect_part(error_of_layer(
                  {VolumeContent{volume_of(std::vector<float>(12, 0), {3, 2, 2}), haze(), mask}}),
              "the mask is not on the grid of the data");
  expect_part(error_of([&] { LabelMask(labels, {{3, haze()}, {3, haze()}}); }), "is there twice");
  expect_part(error_of([&] { LabelMask(labels, {{3, nullptr}}); }), "has no transfer function");
  expect_part(error_of([&] { LabelMask(nullptr, {}); }), "there are no labels");
}

}  // namespace
}  // namespace pellucid::test_layers
