// SPDX-License-Identifier: Apache-2.0

// Light, gradient opacity, isosurfaces and slices: from a document to a scene.

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "pellucid/io/scene_json.h"
#include "pellucid/scene/error.h"
#include "tests/io/scratch_folder.h"
#include "tests/io/vtk/mesh_files.h"
#include "tests/support/one_layer.h"

namespace pellucid::test_light_scenes {
namespace {

using Points = std::vector<TransferFunction::Point>;
using test::error_of;

SceneDescription layer(const std::string& keys) {
  return parse_scene("{\"layers\": [{" + keys + "}]}", "s");
}

const std::string ramp = R"("field": {"builtin": "ramp", "points": 5})";
const std::string two_channels = R"("channels": [{"name": "a", "builtin": "ramp", "points": 5},
                                                 {"name": "b", "builtin": "sphere", "points": 5}])";

TEST(LightScene, ReadsLights) {
  EXPECT_EQ(layer(ramp).lights.size(), 1U);
  EXPECT_TRUE(std::holds_alternative<HeadLight>(layer(ramp).lights.front().kind));
  const std::string layers = "{\"layers\": [{" + ramp + "}], \"lights\": ";
  EXPECT_TRUE(parse_scene(layers + "[]}", "s").lights.empty());
  const std::vector<Light> lights =
      make_scene(parse_scene(layers + R"([{"type": "directional", "direction": [1, 2, 3]},
                                          {"type": "point", "position": [4, 5, 6],
                                           "color": [0, 0.5, 2]}]})",
                             "s"))
          .lights;
  ASSERT_EQ(lights.size(), 2U);
  EXPECT_EQ(std::get<DirectionalLight>(lights[0].kind).direction, (Vec3<double>{1, 2, 3}));
  EXPECT_EQ(lights[0].color, (Rgb<double>{1, 1, 1}));
  EXPECT_EQ(std::get<PointLight>(lights[1].kind).position, (Vec3<double>{4, 5, 6}));
  EXPECT_EQ(lights[1].color, (Rgb<double>{0, 0.5, 2}));
}

TEST(LightScene, ADefaultHeadLightIsNotWritten) {
  SceneDescription scene = layer(ramp);
  EXPECT_EQ(scene_to_json(scene).find("lights"), std::string::npos);
  scene.lights.front().color = {1, 1, 0.5};
  EXPECT_NE(scene_to_json(scene).find("lights"), std::string::npos);
  scene.lights.clear();
  EXPECT_NE(scene_to_json(scene).find("\"lights\": []"), std::string::npos);
}

TEST(LightScene, ReadsShadingAndGradientOpacity) {
  EXPECT_FALSE(layer(ramp).layers[0].shading);
  const Scene defaults = make_scene(layer(ramp + R"(, "shading": {})"));
  EXPECT_EQ(defaults.layers[0].shading, Shading{});
  const Scene scene = make_scene(
      layer(two_channels + R"(, "transfer_function": {"tables": [{"channel": "a", "points": [
        {"value": 0, "extinction": 1, "color": [1, 1, 1]}]}]},
        "shading": {"ambient": 0.1, "diffuse": 0.2, "specular": 0.3, "power": 4,
                    "gradient": "field", "flatness": 0.5, "channel": "b"},
        "gradient_opacity": {"points": [{"gradient": 1, "factor": 2}], "unit": "voxel",
                             "channel": "b"})"));
  EXPECT_EQ(scene.layers[0].shading, (Shading{0.1, 0.2, 0.3, 4, GradientKind::field, 0.5, 1}));
  const GradientOpacity& opacity = *scene.layers[0].gradient_opacity;
  ASSERT_EQ(opacity.points().size(), 1U);
  EXPECT_EQ(opacity.points()[0].gradient, 1);
  EXPECT_EQ(opacity.points()[0].factor, 2);
  EXPECT_EQ(opacity.unit(), GradientOpacity::Unit::voxel);
  EXPECT_EQ(opacity.channel(), 1);
  EXPECT_NO_THROW(check_data(scene));
}

TEST(LightScene, OnlySurfacesWithoutAFunction) {
  const auto function = [](const std::string& keys) {
    const Scene scene = make_scene(layer(ramp + keys));
    check_data(scene);
    return test::volume_of(scene).transfer_function->points();
  };
  const Points surface = function(R"(, "isosurfaces": [{"value": 0.25}])");
  for (const TransferFunction::Point& point : surface) EXPECT_EQ(point.extinction, 0);
  const Points slice = function(R"(, "slices": [{"point": [0, 0, 0], "normal": [1, 0, 0]}])");
  ASSERT_EQ(slice.size(), 2U);
  const Scene whole = make_scene(layer(ramp));
  const Volume& data = *test::volume_of(whole).volume;
  EXPECT_EQ(slice[0].value, data.statistics().minimum);
  EXPECT_EQ(slice[1].value, data.statistics().maximum);
  EXPECT_EQ(slice[0].color, (Rgb<double>{0, 0, 0}));
  EXPECT_EQ(slice[1].color, (Rgb<double>{1, 1, 1}));
  EXPECT_EQ(slice[1].extinction, 0);
  // A given function stays, and so does the default of a layer without surfaces.
  EXPECT_EQ(function(R"(, "isosurfaces": [{"value": 0.25}],
                       "transfer_function": {"points": [
                         {"value": 0, "extinction": 3, "color": [1, 1, 1]}]})")[0]
                .extinction,
            3);
  EXPECT_GT(function(R"(, "isosurfaces": [])").back().extinction, 0);
}

TEST(LightScene, SurfacesOfSeveralVariables) {
  const Scene scene = make_scene(layer(two_channels + R"(, "isosurfaces": [
      {"value": 0.5, "channel": "b", "color_channel": "a", "opacity": 0.5, "colors": {
        "unit_distance": 1,
        "points": [{"value": 0, "opacity": 1, "color": [0, 0, 0]},
                   {"value": 1, "opacity": 0.5, "color": [1, 0, 0]}]}}],
      "slices": [{"point": [1, 2, 3], "normal": [0, 2, 0], "opacity": 0.25, "channel": "b"}])"));
  check_data(scene);
  const Layer& made = scene.layers[0];
  EXPECT_EQ(largest_extinction(made), 0);
  const Isosurface& surface = made.isosurfaces.at(0);
  EXPECT_EQ(surface.channel, 1);
  EXPECT_EQ(surface.color_channel, 0);
  EXPECT_EQ(surface.opacity, 0.5);
  ASSERT_TRUE(surface.colors);
  EXPECT_EQ(surface.colors->relative_error(), 0);
  ASSERT_EQ(surface.colors->points().size(), 2U);
  EXPECT_EQ(surface.colors->points()[1].color, (Rgb<double>{1, 0, 0}));
  EXPECT_EQ(surface.colors->points()[0].extinction, 0);
  const Slice& slice = made.slices.at(0);
  EXPECT_EQ(slice.channel, 1);
  EXPECT_EQ(slice.point, (Vec3<double>{1, 2, 3}));
  EXPECT_EQ(slice.normal, (Vec3<double>{0, 2, 0}));
  // Grey over the range of b.
  ASSERT_TRUE(slice.colors);
  const auto& channels = *std::get<ChannelsContent>(made.content).channels;
  EXPECT_EQ(slice.colors->points().back().value, channels[1].volume->statistics().maximum);
  EXPECT_EQ(slice.colors->points().back().color, (Rgb<double>{1, 1, 1}));
}

class LightSceneOfAMesh : public test::ScratchFolder {
 protected:
  Layer made(const std::string& mesh, const std::string& keys) {
    write("m.vtu", test::small_vtu());
    const Scene scene = make_scene(
        parse_scene("{\"layers\": [{\"mesh\": {\"file\": \"m.vtu\"" + mesh + "}" + keys + "}]}",
                    "s", path("")));
    check_data(scene);
    return scene.layers[0];
  }
};

TEST_F(LightSceneOfAMesh, OfOneVariable) {
  const Layer layer =
      made("", R"(, "shading": {}, "slices": [{"point": [0, 0, 0.25], "normal": [0, 0, 1]}])");
  EXPECT_EQ(largest_extinction(layer), 0);
  EXPECT_FALSE(layer.slices[0].colors);
  const TransferFunction& grey = *std::get<MeshContent>(layer.content).univariate();
  EXPECT_EQ(grey.points().back().value, 4);
  EXPECT_EQ(grey.points().back().color, (Rgb<double>{1, 1, 1}));
}

TEST_F(LightSceneOfAMesh, OfSeveralVariables) {
  const Layer layer = made(R"(, "channels": [{"array": "p"}, {"name": "x", "array": "v",
                                                              "component": 0}])",
                           R"(, "isosurfaces": [{"value": 1.5, "channel": "x", "color_channel": "x",
                                                 "colors": {"preset": "simulation-diverging"}}],
                               "slices": [{"point": [0, 0, 0.25], "normal": [0, 0, 1],
                                           "channel": "x"}])");
  EXPECT_EQ(largest_extinction(layer), 0);
  EXPECT_EQ(layer.isosurfaces[0].channel, 1);
  EXPECT_EQ(layer.isosurfaces[0].color_channel, 1);
  // x is from 0 to 3, p to 4.
  ASSERT_TRUE(layer.slices[0].colors);
  EXPECT_EQ(layer.slices[0].colors->points().back().value, 3);
  EXPECT_LE(layer.isosurfaces[0].colors->points().back().value, 3.1);
}

TEST(LightScene, ColorsMayBeAPreset) {
  const Scene scene = make_scene(
      layer(ramp + R"(, "isosurfaces": [{"value": 0.5, "colors": {"preset": "x-ray"}}])"));
  ASSERT_TRUE(scene.layers[0].isosurfaces[0].colors);
  EXPECT_GT(scene.layers[0].isosurfaces[0].colors->points().size(), 1U);
}

TEST(LightScene, AValueIsOnceInEachVariable) {
  EXPECT_NO_THROW(
      layer(two_channels + R"(, "isosurfaces": [{"value": 1}, {"value": 1, "channel": "b"}])"));
  EXPECT_NE(
      error_of([] {
        layer(two_channels + R"(, "isosurfaces": [{"value": 1}, {"value": 1, "channel": "a"}])");
      }).find("/layers/0/isosurfaces/1/value: stands twice"),
      std::string::npos);
}

TEST(LightScene, LightCountsForOpacityTables) {
  SceneDescription description =
      layer(ramp + R"(, "transfer_function": {"unit_distance": 0.5, "points": [
        {"value": 0, "opacity": 0, "color": [1, 1, 1]},
        {"value": 1, "opacity": 0.99, "color": [1, 1, 1]}]},
        "shading": {"ambient": 1, "diffuse": 3, "specular": 5},
        "isosurfaces": [{"value": 0.5, "color": [20, 0, 0]}])");
  description.lights.push_back({DirectionalLight{}, {0, 2, 0}});
  description.integration.tolerance = 1e-3;
  EXPECT_LE(approximation_error(make_scene(description)), 1e-3 / 8);
}

TEST(LookFile, HasShadingAndGradientOpacityBesideTheFunction) {
  const std::string function = R"({"points": [{"value": 0, "extinction": 1, "color": [1, 1, 1]}]})";
  const LookDescription bare = parse_look(function, "f");
  EXPECT_FALSE(bare.shading);
  EXPECT_FALSE(bare.gradient_opacity);
  EXPECT_EQ(look_to_json(bare), transfer_function_to_json(bare.transfer_function));

  const std::string text = "{\"transfer_function\": " + function +
                           R"(, "shading": {"power": 5}, "gradient_opacity": {"points": [
                               {"gradient": 0, "factor": 0.5}], "unit": "voxel"}})";
  const LookDescription look = parse_look(text, "f");
  ASSERT_TRUE(look.shading);
  EXPECT_EQ(look.shading->power, 5);
  ASSERT_TRUE(look.gradient_opacity);
  EXPECT_EQ(look.gradient_opacity->unit(), GradientOpacity::Unit::voxel);
  const std::string written = look_to_json(look);
  EXPECT_EQ(look_to_json(parse_look(written, "again")), written);
  EXPECT_EQ(transfer_function_to_json(parse_transfer_function(text, "f")),
            transfer_function_to_json(bare.transfer_function));
  EXPECT_EQ(error_of([&] {
              parse_look("{\"transfer_function\": " + function + ", \"shading\": 1}", "f");
            }),
            "f: /shading: must be an object, but is 1");
  EXPECT_NE(error_of([&] {
              parse_look("{\"transfer_function\": " + function + ", \"slices\": []}", "f");
            }).find("f: /slices: unknown key"),
            std::string::npos);
}

TEST(LookFile, FindsItsChannelsWhenTheDataAreKnown) {
  SceneDescription scene = layer(ramp);
  scene.layers[0].shading.emplace().channel = "edge";
  EXPECT_EQ(error_of([&] { make_scene(scene); }),
            "scene: shading looks at a channel \"edge\", which is not there; there are: value");
}

TEST(LookJson, TellsOfALayer) {
  EXPECT_EQ(layer_look_to_json(LayerDescription{}), "{}");
  const std::string text = layer_look_to_json(
      layer(ramp + R"(, "shading": {}, "isosurfaces": [{"value": 0.5}])").layers[0]);
  const SceneDescription again = layer(ramp + ", " + text.substr(1, text.size() - 2));
  EXPECT_EQ(layer_look_to_json(again.layers[0]), text);
  EXPECT_EQ(lights_to_json({}), "[]");
}

}  // namespace
}  // namespace pellucid::test_light_scenes
