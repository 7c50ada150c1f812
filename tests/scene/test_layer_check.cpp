// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "expect_error.h"
#include "layer_contents.h"
#include "pellucid/scene/scene.h"

namespace pellucid::test_layer_check {
namespace {

std::string refusal(const Layer& layer) {
  return error_message([&] { check_layer(layer, "layer 2"); });
}

std::string refusal(LayerContent content) {
  Layer layer;
  layer.content = std::move(content);
  return refusal(layer);
}

std::shared_ptr<const LabelVolume> labels_on(const Volume::Description& d) {
  return std::make_shared<const LabelVolume>(counting(d));
}

std::shared_ptr<const LabelMask> mask_on(const Volume::Description& d) {
  return std::make_shared<const LabelMask>(labels_on(d),
                                           std::vector<LabelMask::Choice>{{3, table_of(7, 2)}});
}

std::shared_ptr<const LabelTable> colors() {
  return std::make_shared<const LabelTable>(std::vector<LabelStyle>{{1, "", {0, 6, 0}, 4}});
}

Layer plain_layer() {
  Layer layer;
  layer.content = VolumeContent{counting(exact_grid()), table_of(1, 1), nullptr};
  return layer;
}

constexpr char needed[] = " are needed; set both before rendering";

TEST(CheckLayer, VolumesHaveAFunction) {
  const auto volume = counting(exact_grid());
  EXPECT_EQ(refusal(VolumeContent{volume, table_of(1, 1), nullptr}), "");
  const std::string text = std::string("layer 2: a volume and a transfer function") + needed;
  EXPECT_EQ(refusal(VolumeContent{}), text);
  EXPECT_EQ(refusal(VolumeContent{volume, nullptr, nullptr}), text);
  EXPECT_EQ(refusal(VolumeContent{nullptr, table_of(1, 1), nullptr}), text);
  EXPECT_EQ(refusal(VolumeContent{nullptr, table_of(1, 1), mask_on(exact_grid())}), text);
}

TEST(CheckLayer, MasksAreOnTheGridOfTheData) {
  const auto refusal_of = [](const Volume::Description& d) {
    return refusal(VolumeContent{counting(exact_grid()), table_of(1, 1), mask_on(d)});
  };
  EXPECT_EQ(refusal_of(exact_grid()), "");
  Volume::Description d = exact_grid();
  d.dimensions = {2, 2, 2};
  EXPECT_EQ(refusal_of(d),
            "layer 2: the mask is not on the grid of the data: channels: channel \"mask\" (small) "
            "and channel \"data\" (small) are not on one grid: 2 x 2 x 2 and 3 x 2 x 2 "
            "values; resample one to the other's grid");
  d = exact_grid();
  d.placement.origin.x += 1;
  const std::string apart = refusal_of(d);
  EXPECT_TRUE(apart.starts_with("layer 2: the mask is not on the grid of the data: ")) << apart;
  EXPECT_NE(apart.find("not at one place"), std::string::npos) << apart;
}

TEST(CheckLayer, ChannelsHaveAFunctionOfAsMany) {
  EXPECT_EQ(refusal(ChannelsContent{two_channels(), gaussian_of(2)}), "");
  const std::string text = std::string("layer 2: channels and a multivariate function") + needed;
  EXPECT_EQ(refusal(ChannelsContent{}), text);
  EXPECT_EQ(refusal(ChannelsContent{two_channels(), nullptr}), text);
  EXPECT_EQ(refusal(ChannelsContent{nullptr, gaussian_of(2)}), text);
  EXPECT_EQ(refusal(ChannelsContent{two_channels(), gaussian_of(3)}),
            "layer 2: the transfer function sees 3 channels, but there are 2; make it for as many");
}

TEST(CheckLayer, MeshesHaveAFunctionOfOneOrOfAll) {
  EXPECT_EQ(refusal(MeshContent{two_tetrahedra(1), table_of(1, 1)}), "");
  EXPECT_EQ(refusal(MeshContent{two_tetrahedra(1), gaussian_of(1)}), "");
  EXPECT_EQ(refusal(MeshContent{two_tetrahedra(2), gaussian_of(2)}), "");
  const std::string text = std::string("layer 2: a mesh and a transfer function") + needed;
  EXPECT_EQ(refusal(MeshContent{}), text);
  EXPECT_EQ(refusal(MeshContent{two_tetrahedra(1), {}}), text);
  EXPECT_EQ(refusal(MeshContent{two_tetrahedra(1),
                                std::shared_ptr<const MultivariateTransferFunction>()}),
            text);
  EXPECT_EQ(refusal(MeshContent{nullptr, table_of(1, 1)}), text);
  EXPECT_EQ(refusal(MeshContent{nullptr, gaussian_of(1)}), text);
  EXPECT_EQ(refusal(MeshContent{two_tetrahedra(2), table_of(1, 1)}),
            "layer 2: the transfer function sees one variable, but the mesh has 2 channels; leave "
            "one of them");
  EXPECT_EQ(refusal(MeshContent{two_tetrahedra(2), gaussian_of(1)}),
            "layer 2: the transfer function sees 1 channels, but there are 2; make it for as many");
}

TEST(CheckLayer, LabelsHaveColors) {
  EXPECT_EQ(refusal(LabelContent{labels_on(exact_grid()), colors()}), "");
  const std::string text = std::string("layer 2: labels and a table of colors") + needed;
  EXPECT_EQ(refusal(LabelContent{}), text);
  EXPECT_EQ(refusal(LabelContent{labels_on(exact_grid()), nullptr}), text);
  EXPECT_EQ(refusal(LabelContent{nullptr, colors()}), text);
}

TEST(CheckLayer, TransformsAreFiniteAndRegular) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  Layer layer = plain_layer();
  layer.transform.matrix.column[1] = {0, nan, 0};
  EXPECT_EQ(refusal(layer),
            "layer 2: transform has the column (0, nan, 0), but all of its numbers must be finite");
  layer = plain_layer();
  layer.transform.translation = {1, 2, infinity};
  EXPECT_EQ(refusal(layer),
            "layer 2: transform has the column (1, 2, inf), but all of its numbers must be finite");
  const std::string singular =
      "layer 2: transform is singular; its columns must be three independent axes";
  layer = plain_layer();
  layer.transform.matrix.column[2] = {0, 0, 0};
  EXPECT_EQ(refusal(layer), singular);
  layer.transform.matrix.column[2] = {1, 1, 0};
  EXPECT_EQ(refusal(layer), singular);
  layer.transform.matrix.column[2] = {1, 1, 1e-9};
  EXPECT_EQ(refusal(layer), singular);
  layer.transform.matrix.column[2] = {1, 1, 1e-7};
  EXPECT_EQ(refusal(layer), "");
  // Mirrors are places too, and units of length do not matter.
  for (const double scale : {-1.0, 1e-120, 1e120}) {
    layer.transform.matrix = {{{scale, 0, 0}, {0, scale, 0}, {0, 0, scale}}};
    EXPECT_EQ(refusal(layer), "") << scale;
  }
}

TEST(CheckLayer, ClipsAreCountedFromOne) {
  Layer layer = plain_layer();
  layer.clips = {{ClipBox{}}, {ClipSphere{{0, 0, 0}, 0}, false}};
  EXPECT_EQ(refusal(layer), "layer 2: clip 2: radius is 0, but must be a positive number");
}

TEST(CheckData, SaysWhichLayer) {
  const auto refusal_of = [](const Scene& scene) {
    return error_message([&] { check_data(scene); });
  };
  const std::string text = std::string("a volume and a transfer function") + needed;
  Scene scene;
  EXPECT_EQ(refusal_of(scene), "scene: there is no layer; give at least one");
  scene.layers.emplace_back();
  EXPECT_EQ(refusal_of(scene), "scene: " + text);
  scene.layers[0].name = "dose";
  EXPECT_EQ(refusal_of(scene), "layer \"dose\": " + text);
  scene.layers.insert(scene.layers.begin(), plain_layer());
  EXPECT_EQ(refusal_of(scene), "layer \"dose\": " + text);
  scene.layers[1].name.clear();
  EXPECT_EQ(refusal_of(scene), "layer 2: " + text);
  scene.layers[1].visible = false;  // checked all the same
  EXPECT_EQ(refusal_of(scene), "layer 2: " + text);
  scene.layers.pop_back();
  EXPECT_EQ(refusal_of(scene), "");
  scene.clips = {{ClipBox{}}, {ClipPlane{{0, 0, 0}, {0, 0, 0}}}};
  EXPECT_EQ(refusal_of(scene), "scene: clip 2: normal is (0, 0, 0), but must have a length");
}

TEST(Layer, TheNumbersOfItsFunctions) {
  Layer layer;
  const auto expect = [&](double color, double extinction) {
    EXPECT_EQ(largest_color(layer), color);
    EXPECT_EQ(largest_extinction(layer), extinction);
    EXPECT_EQ(approximation_error(layer, 1), 0);
  };
  layer.content = VolumeContent{counting(exact_grid()), table_of(3, 0.5), nullptr};
  expect(0.5, 3);
  layer.content = VolumeContent{counting(exact_grid()), table_of(3, 0.5), mask_on(exact_grid())};
  expect(2, 7);
  layer.content = ChannelsContent{two_channels(), gaussian_of(2)};
  expect(5, 3);
  layer.content = MeshContent{two_tetrahedra(1), table_of(3, 0.5)};
  expect(0.5, 3);
  layer.content = MeshContent{two_tetrahedra(2), gaussian_of(2)};
  expect(5, 3);
  layer.content = LabelContent{labels_on(exact_grid()), colors()};
  expect(6, 4);
  // Of a mask, the worst of its functions.
  const auto rough = std::make_shared<const TransferFunction>(
      std::vector<TransferFunction::Point>{{0, 1, {1, 1, 1}}}, 1e-3, 0);
  const auto mask = std::make_shared<const LabelMask>(labels_on(exact_grid()),
                                                      std::vector<LabelMask::Choice>{{3, rough}});
  layer.content = VolumeContent{counting(exact_grid()), table_of(3, 0.5), mask};
  EXPECT_EQ(approximation_error(layer, 1), rough->approximation_error(1));
}

TEST(Layer, TheGridThatRaysCross) {
  Layer layer;
  const auto volume = counting(exact_grid());
  layer.content = VolumeContent{volume, nullptr, nullptr};
  EXPECT_EQ(grid_of(layer), volume.get());
  const auto channels = two_channels();
  layer.content = ChannelsContent{channels, nullptr};
  EXPECT_EQ(grid_of(layer), &channels->grid());
  layer.content = MeshContent{two_tetrahedra(1), {}};
  EXPECT_EQ(grid_of(layer), nullptr);
  const auto labels = labels_on(exact_grid());
  layer.content = LabelContent{labels, nullptr};
  EXPECT_EQ(grid_of(layer), &labels->volume());
}

TEST(Scene, TheOnlyLayerAndItsContent) {
  Scene scene;
  EXPECT_EQ(only_layer(scene), nullptr);
  EXPECT_EQ(only_content<VolumeContent>(scene), nullptr);
  scene.layers = {plain_layer()};
  EXPECT_EQ(only_layer(scene), scene.layers.data());
  EXPECT_EQ(only_content<VolumeContent>(scene), &std::get<VolumeContent>(scene.layers[0].content));
  EXPECT_EQ(only_content<MeshContent>(scene), nullptr);
  scene.layers.push_back(plain_layer());
  EXPECT_EQ(only_layer(scene), nullptr);
  EXPECT_EQ(only_content<VolumeContent>(scene), nullptr);
}

TEST(Scene, TheLargestColorIsOfWhatIsVisible) {
  Scene scene;
  scene.layers = {plain_layer(), plain_layer()};
  scene.layers[1].content = VolumeContent{counting(exact_grid()), table_of(1, 8), nullptr};
  EXPECT_EQ(largest_color(scene), 8);
  scene.layers[1].visible = false;
  EXPECT_EQ(largest_color(scene), 1);
}

}  // namespace
}  // namespace pellucid::test_layer_check
