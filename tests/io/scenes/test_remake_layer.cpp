// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <variant>

#include "pellucid/io/scene_json.h"
#include "pellucid/scene/error.h"

namespace pellucid::test_remake_layer {
namespace {

SceneDescription described(const char* look) {
  return parse_scene(
      std::string(R"({"layers": [{"field": {"builtin": "sphere", "points": 16})") + look + "}]}",
      "scene");
}

const VolumeContent& volume_of(const Layer& layer) {
  return std::get<VolumeContent>(layer.content);
}

TEST(RemakeLayer, KeepsTheDataAndTakesTheLook) {
  const Scene scene = make_scene(described(""));
  const SceneDescription next = described(
      R"(, "visible": false, "shading": {"ambient": 0.5}, "isosurfaces": [{"value": 0.4}],
      "transfer_function": {"points": [{"value": 0.25, "extinction": 3, "color": [1, 0, 0]}]})");
  const Layer layer = remake_layer(next, 0, scene.layers[0]);
  EXPECT_EQ(volume_of(layer).volume, volume_of(scene.layers[0]).volume);
  EXPECT_EQ(volume_of(layer).transfer_function->points().front().value, 0.25);
  EXPECT_FALSE(layer.visible);
  EXPECT_EQ(layer.shading->ambient, 0.5);
  EXPECT_EQ(layer.isosurfaces.size(), 1U);
}

TEST(RemakeLayer, ReadsWhatChannelsNeed) {
  const Scene scene = make_scene(described(""));
  const char* const gaussians = R"(, "transfer_function": {"gaussians": [
      {"channels": ["value", "gradient_magnitude"], "center": [0.5, 1], "width": [0.1, 1],
       "extinction": 1, "color": [1, 1, 1]}]})";
  const SceneDescription next = described(gaussians);
  const Layer layer = remake_layer(next, 0, scene.layers[0]);
  const auto& channels = *std::get<ChannelsContent>(layer.content).channels;
  EXPECT_EQ(channels.count(), 2);
  // The same channels are kept from then on.
  const Layer again = remake_layer(next, 0, layer);
  EXPECT_EQ(&*std::get<ChannelsContent>(again.content).channels, &channels);
}

TEST(RemakeLayer, RefusesAChannelThatIsNotThere) {
  const Scene scene = make_scene(described(""));
  EXPECT_THROW(remake_layer(described(R"(, "shading": {"channel": "t1"})"), 0, scene.layers[0]),
               Error);
}

TEST(CompleteDescription, WritesWhatAPresetMade) {
  SceneDescription description =
      described(R"(, "transfer_function": {"preset": "simulation-diverging"})");
  const Scene scene = make_scene(description);
  complete_description(scene.layers[0], description.layers[0]);
  const auto* const points =
      std::get_if<std::vector<TransferFunction::Point>>(&*description.layers[0].transfer_function);
  ASSERT_NE(points, nullptr);
  EXPECT_EQ(points->size(), volume_of(scene.layers[0]).transfer_function->points().size());
}

}  // namespace
}  // namespace pellucid::test_remake_layer
