// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "pellucid/io/scene_json.h"
#include "tests/scene/expect_error.h"
#include "tests/support/one_layer.h"

namespace pellucid::test_multivariate_scenes {
namespace {

using Names = std::vector<std::string>;
using Matrix = std::vector<std::vector<double>>;

SceneDescription valid(const char* name) {
  const std::string path =
      std::string(PELLUCID_SOURCE_DIR) + "/tests/io/scenes/valid/" + name + ".json";
  std::ifstream file(path);
  EXPECT_TRUE(file) << path;
  return parse_scene(std::string(std::istreambuf_iterator<char>(file), {}), name, "/scans");
}

const MultivariateDescription& function_of(const SceneDescription& scene) {
  return std::get<MultivariateDescription>(*scene.layers[0].transfer_function);
}

SceneDescription sphere(MultivariateDescription function) {
  SceneDescription scene;
  scene.layers[0].field = parse_field_source("builtin:sphere:12");
  scene.layers[0].transfer_function = std::move(function);
  return scene;
}

GaussianPrimitive gaussian(const Names& channels, std::vector<double> center) {
  GaussianPrimitive g;
  g.channels.assign(channels.begin(), channels.end());
  g.shape = GaussianWidths{std::vector<double>(center.size(), 0.5), {}};
  g.center = std::move(center);
  g.extinction = 2;
  g.color = {1, 0.5, 0.25};
  return g;
}

TEST(MultivariateScene, IsReadAsWritten) {
  const SceneDescription scene = valid("channels");
  ASSERT_EQ(scene.layers[0].channels.size(), 6U);
  EXPECT_EQ(channel_names(scene.layers[0].channels), (Names{"t1",
                                                            "Gr\xc3\xb6\xc3\x9f"
                                                            "e",
                                                            "b", "edge", "bend", "soft"}));
  EXPECT_EQ(scene.layers[0].channels[0].unit, "a.u.");
  const auto& file = std::get<FieldSource>(scene.layers[0].channels[0].source);
  EXPECT_EQ(file.file, "/scans/patient/T1.vti");
  EXPECT_EQ(file.options.spacing, (Vec3<double>{1, 1, 2}));
  EXPECT_EQ(std::get<FieldSource>(scene.layers[0].channels[1].source).options.type, "u16");
  EXPECT_EQ(std::get<FieldSource>(scene.layers[0].channels[2].source).points, 16);
  const auto& soft = std::get<DerivedSource>(scene.layers[0].channels[5].source);
  EXPECT_EQ(soft.kind, DerivedSource::Kind::smoothed);
  EXPECT_EQ(soft.channel, "t1");
  EXPECT_EQ(soft.sigma, 0.1);
  EXPECT_EQ(std::get<DerivedSource>(scene.layers[0].channels[4].source).channel, "edge");

  const MultivariateDescription& function = function_of(scene);
  EXPECT_EQ(function.channels, (Names{"t1", "edge"}));
  ASSERT_EQ(function.gaussians.size(), 4U);
  EXPECT_TRUE(function.gaussians[0].channels.empty());
  EXPECT_EQ(function.gaussians[0].center, (std::vector<double>{80, -20.5}));
  EXPECT_EQ(std::get<GaussianWidths>(*function.gaussians[1].shape).axes,
            (Matrix{{0.6, 0.8}, {-0.8, 0.6}}));
  EXPECT_EQ(std::get<GaussianCovariance>(*function.gaussians[2].shape).covariance,
            (Matrix{{4, 1}, {1, 0.5}}));
  EXPECT_EQ(function.gaussians[3].matrix.size(), 3U);
  EXPECT_EQ(function.gaussians[3].color, (Rgb<double>{0, 1, 0}));
  ASSERT_EQ(function.tables.size(), 2U);
  EXPECT_EQ(function.tables[0].channel, "soft");
  EXPECT_EQ(function.tables[0].function.points()[1].extinction, 0.1);
}

TEST(MultivariateScene, TermsFindTheirChannels) {
  const SceneDescription scene = valid("channels");
  const auto made = make_multivariate(function_of(scene), channel_names(scene.layers[0].channels));
  EXPECT_EQ(made->channels(), 6);
  EXPECT_EQ(made->primitives()[0].channels, (std::vector<ChannelRef>{0, 3}));
  EXPECT_EQ(made->primitives()[1].channels, (std::vector<ChannelRef>{5, 2}));
  EXPECT_EQ(made->primitives()[2].channels, (std::vector<ChannelRef>{0, 4}));
  EXPECT_EQ(made->primitives()[3].channels, (std::vector<ChannelRef>{2, 1}));
  EXPECT_EQ(made->primitives()[0].matrix, (Matrix{{0.1, 0}, {0, 0.2}}));
  EXPECT_EQ(made->primitives()[2].matrix, matrix_from_covariance({{4, 1}, {1, 0.5}}));
  EXPECT_EQ(made->primitives()[3].matrix, (Matrix{{0.1, -0.3}, {0, 0}, {1, 1}}));
  EXPECT_EQ(made->tables()[0].channel, 5);
  EXPECT_EQ(made->tables()[1].channel, 0);
}

TEST(MultivariateScene, AFieldIsTheChannelValue) {
  MultivariateDescription function;
  function.gaussians = {gaussian({}, {0.5})};
  const Scene scene = make_scene(sphere(function));
  EXPECT_NO_THROW(check_data(scene));
  const Channels& channels = *test::channels_of(scene).channels;
  EXPECT_EQ(channels.count(), 1);
  EXPECT_EQ(channels[0].name, "value");
  EXPECT_EQ(test::grid_volume(scene).description().dimensions, (std::array<int, 3>{12, 12, 12}));
  EXPECT_NO_THROW(make_camera_frame(scene.camera, scene.size));
}

TEST(MultivariateScene, WhatIsMadeOfAFieldIsMadeWhereItIsNamed) {
  const auto channels = [](MultivariateDescription function) {
    return channel_names(layer_channels(sphere(std::move(function)).layers[0]));
  };
  const Names both{"value", "gradient_magnitude"};
  MultivariateDescription f;
  f.gaussians = {gaussian({"gradient_magnitude", "value"}, {1, 2})};
  EXPECT_EQ(channels(f), both);
  f.gaussians = {gaussian({}, {1, 2})};
  f.channels = both;
  EXPECT_EQ(channels(f), both);
  f = {};
  f.tables = {{"second_derivative", TransferFunction({{0, 1, {1, 1, 1}}})}};
  EXPECT_EQ(channels(f), (Names{"value", "second_derivative"}));
  f.gaussians = {gaussian({"gradient_magnitude"}, {1})};
  EXPECT_EQ(channels(f), (Names{"value", "gradient_magnitude", "second_derivative"}));
  EXPECT_TRUE(layer_channels(LayerDescription{}).empty());

  f.gaussians = {gaussian(both, {0.5, 1})};
  f.tables.clear();
  const Scene scene = make_scene(sphere(f));
  const Channels& made = *test::channels_of(scene).channels;
  ASSERT_EQ(made.count(), 2);
  // The field is the distance from the middle: its gradient is 1 where nothing bends.
  const auto& slope = std::get<DataArray<float>>(made[1].volume->data());
  EXPECT_NEAR(static_cast<double>(slope[6 + 12 * (6 + 12 * std::size_t{10})]), 1, 0.02);
}

TEST(MultivariateScene, AFactorFindsItsChannelAndIsWrittenBack) {
  const SceneDescription scene = valid("factor");
  const auto& factor = function_of(scene).factor;
  ASSERT_TRUE(factor);
  EXPECT_EQ(factor->channel, "w");
  const auto points = [](const ChannelTransferFunction& of) {
    std::vector<std::array<double, 2>> list;
    for (const auto& point : of.function.points()) list.push_back({point.value, point.extinction});
    return list;
  };
  EXPECT_EQ(points(*factor),
            (std::vector<std::array<double, 2>>{{-0.5, 0}, {0.5, 2}, {0.5, 0.25}}));
  const Scene made = make_scene(scene);
  const MultivariateTransferFunction& function = *test::channels_of(made).transfer_function;
  ASSERT_NE(function.factor(), nullptr);
  EXPECT_EQ(function.factor()->channel, 1);
  EXPECT_EQ(function.factor()->function.points().at(1).extinction, 2);
  EXPECT_EQ(function.largest_extinction(), 2);
  // The second layer's channel is made because the factor names it.
  EXPECT_EQ(std::get<ChannelsContent>(made.layers.at(1).content).channels->count(), 2);
  const SceneDescription again = parse_scene(scene_to_json(scene), "again");
  EXPECT_EQ(function_of(again).factor->channel, "w");
  EXPECT_EQ(points(*function_of(again).factor), points(*factor));
}

TEST(MultivariateScene, ChannelsNeedAFunctionOfTheirOwn) {
  SceneDescription scene;
  scene.layers[0].channels = {{"a", "", parse_field_source("builtin:ramp:4")}};
  expect_error([&] { make_scene(scene); },
               {"channels need a transfer function", "pellucid suggest"});
  scene.layers[0].transfer_function = std::vector<TransferFunction::Point>{{0, 1, {1, 1, 1}}};
  expect_error([&] { make_scene(scene); }, {"points in one variable", "\"tables\""});
  expect_error(
      [] {
        MultivariateDescription f;
        f.gaussians = {gaussian({}, {1})};
        make_transfer_function(f, 1e-3);
      },
      {"points in one variable are needed"});
}

TEST(MultivariateScene, UnknownChannelsAreFoundBeforeAnythingIsRead) {
  MultivariateDescription f;
  f.gaussians = {gaussian({"value"}, {1}), gaussian({"gradient_magnitud"}, {1})};
  SceneDescription scene = sphere(f);
  scene.layers[0].field = parse_field_source("/nowhere/a.nii.gz");
  expect_error(
      [&] { make_scene(scene); },
      {"Gaussian 1 looks at a channel \"gradient_magnitud\", which is not there (did you mean "
       "\"gradient_magnitude\"?); there are: value, gradient_magnitude, second_derivative"});
  scene.layers[0].channels = {{"a", "", scene.layers[0].field}};
  expect_error([&] { make_scene(scene); }, {"\"value\", which is not there; there are: a"});
}

}  // namespace
}  // namespace pellucid::test_multivariate_scenes
