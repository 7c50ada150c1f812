// SPDX-License-Identifier: Apache-2.0
#include "view/scene_state.h"

#include <gtest/gtest.h>

#include <string>

#include "pellucid/cpu/render.h"
#include "pellucid/scene/error.h"
#include "view/overlay.h"

namespace pellucid::view::scene_state_test {
namespace {

SceneState state_of(const std::string& layers) {
  SceneDescription description = parse_scene(
      R"({"layers": [)" + layers + R"(], "image": {"width": 24, "height": 16}})", "test");
  Scene scene = make_scene(description);
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    complete_description(scene.layers[i], description.layers[i]);
  }
  description.camera = scene.camera;
  return {std::move(description), std::move(scene), {}};
}

SceneState sphere() {
  return state_of(R"({"field": {"builtin": "sphere", "points": 16}})");
}

Edit edit_of(std::optional<std::size_t> layer, const char* key, const char* value, int gesture) {
  return {layer, key, Json::parse(value), gesture};
}

const char* const red = R"({"points": [{"value": 0, "extinction": 2, "color": "#ff0000"}]})";

TEST(SceneState, TakesAFunctionWithAColorOfAPicker) {
  SceneState state = sphere();
  state.edit(edit_of(0, "transfer_function", red, 1));
  const auto& volume = std::get<VolumeContent>(state.scene().layers[0].content);
  EXPECT_EQ(volume.transfer_function->points().front().color, (Rgb<double>{1, 0, 0}));
}

TEST(SceneState, WhatIsSavedRendersToTheSameBits) {
  SceneState state = sphere();
  state.edit(edit_of(0, "transfer_function", red, 1));
  state.edit(edit_of({}, "clip", R"([{"plane": {"point": [0, 0, 0], "normal": [0.1, 1, 0]}}])", 2));
  state.edit(
      edit_of(0, "isosurfaces", R"([{"value": 0.5, "color": "#00ff80", "opacity": 0.3}])", 3));
  state.edit(edit_of(0, "shading", "{}", 4));
  state.edit(edit_of({}, "background", "\"#203040\"", 5));
  state.set_tolerance(1e-3);
  const Scene again = make_scene(parse_scene(state.saved(), "saved"));
  EXPECT_EQ(render(state.scene()).image.pixels, render(again).image.pixels);
  EXPECT_EQ(again.integration.tolerance, 1e-3);
}

TEST(SceneState, SuggestionsSayWhetherThereIsLight) {
  SceneState state = sphere();
  const auto is_lit = [&] { return state.description().layers[0].shading.has_value(); };
  state.edit(edit_of(0, "shading", "{}", 1));
  ASSERT_TRUE(is_lit());
  MultivariateDescription gaussians;
  gaussians.channels = {"value"};
  gaussians.gaussians.push_back({{"value"}, {0.5}, {{10}}, 1, {1, 1, 1}});
  state.set_gaussians(0, gaussians);
  EXPECT_FALSE(is_lit());
  state.undo();
  EXPECT_TRUE(is_lit());
  state.set_default_function(0);  // a sphere of smooth data has no surfaces
  EXPECT_FALSE(is_lit());
}

MultivariateDescription gaussian_at(double center) {
  MultivariateDescription function;
  function.channels = {"value"};
  function.gaussians.push_back({{"value"}, {center}, {{10}}, 1, {1, 1, 1}});
  return function;
}

TEST(SceneState, RefinesGaussiansInTheHistoryToo) {
  SceneState state = sphere();
  state.set_gaussians(0, gaussian_at(0.5));
  const std::string quick = state.function_text(0);
  state.edit(edit_of({}, "clip", R"([{"sphere": {"center": [0, 0, 0], "radius": 0.5}}])", 1));
  state.edit(edit_of(0, "shading", "{}", 2));
  state.undo();
  state.refine_gaussians(0, gaussian_at(0.7));
  const std::string refined = state.function_text(0);
  EXPECT_NE(refined, quick);
  EXPECT_EQ(state.scene().clips.size(), 1U);
  const auto& content = std::get<ChannelsContent>(state.scene().layers[0].content);
  EXPECT_EQ(content.transfer_function->primitives().front().center, (std::vector<double>{0.7}));
  // No step of its own: the last one is that of the clip.
  state.undo();
  EXPECT_EQ(state.scene().clips.size(), 0U);
  EXPECT_EQ(state.function_text(0), refined);
  state.redo();
  state.redo();
  EXPECT_TRUE(state.description().layers[0].shading);
  EXPECT_EQ(state.function_text(0), refined);
  // The function before the first one is another.
  for (int i = 0; i < 3; ++i) state.undo();
  EXPECT_NE(state.function_text(0), refined);
}

TEST(SceneState, UndoesGesturesAsAWhole) {
  SceneState state = sphere();
  const std::string first = state.saved();
  state.edit(edit_of(0, "transfer_function", red, 1));
  state.edit(edit_of({}, "clip", R"([{"sphere": {"center": [0, 0, 0], "radius": 0.5}}])", 2));
  const std::string with_clip = state.saved();
  for (const char* radius : {"0.6", "0.7", "0.8"}) {
    const std::string clip =
        R"([{"sphere": {"center": [0, 0, 0], "radius": )" + std::string(radius) + "}}]";
    state.edit(edit_of({}, "clip", clip.c_str(), 3));
  }
  const std::string last = state.saved();
  state.undo();
  EXPECT_EQ(state.saved(), with_clip);
  state.undo();
  state.undo();
  EXPECT_EQ(state.saved(), first);
  EXPECT_FALSE(state.can_undo());
  state.undo();  // there is nothing more
  while (state.can_redo()) state.redo();
  EXPECT_EQ(state.saved(), last);
}

TEST(SceneState, RefusesAndStaysAsItWas) {
  SceneState state = sphere();
  const std::string before = state.saved();
  const std::pair<const char*, const char*> wrong[] = {
      {"field", R"({"file": "/etc/passwd"})"},
      {"mask", "{}"},
      {"name", "\"x\""},
      {"transfer_function", R"({"points": []})"},
      {"transfer_function", R"({"points": [{"value": 0, "extinction": -1, "color": [1, 1, 1]}]})"},
      {"transfer_function", R"({"preset": "nothing"})"},
      {"transfer_function", R"({"points": [{"value": 0, "extinction": 1, "color": "red; drop"}]})"},
      {"colors", "[]"},
      {"clip", R"([{"box": {"lower": [0, 0, 0], "upper": [0, 0, 0]}}])"},
      {"isosurfaces", "7"},
      {"projection", "\"median\""},
      {"shading", R"({"channel": "t2"})"},
  };
  for (const auto& [key, value] : wrong) {
    EXPECT_THROW(state.edit(edit_of(0, key, value, 1)), Error) << key << value;
    EXPECT_EQ(state.saved(), before) << key;
  }
  for (const char* key : {"layers", "image", "camera", "pellucid", "backdrop", "integration"}) {
    EXPECT_THROW(state.edit(edit_of({}, key, "{}", 1)), Error) << key;
  }
  EXPECT_THROW(state.edit(edit_of(1, "visible", "false", 1)), Error);
  EXPECT_FALSE(state.can_undo());
}

TEST(SceneState, KeepsTheDataOfOtherLayers) {
  SceneState state = state_of(
      R"({"field": {"builtin": "sphere", "points": 16}},
         {"field": {"builtin": "shells", "points": 16}})");
  const auto function_of = [&](std::size_t i) {
    return std::get<VolumeContent>(state.scene().layers[i].content);
  };
  const VolumeContent first = function_of(0), second = function_of(1);
  state.edit(edit_of(0, "transfer_function", red, 1));
  EXPECT_EQ(function_of(0).volume, first.volume);
  // What a renderer knows of it stays valid (Renderer).
  EXPECT_EQ(function_of(1), second);
}

TEST(SceneState, GaussiansBecomeMatricesOfTheSameFunction) {
  const std::string layer = R"({"field": {"builtin": "sphere", "points": 16},
      "transfer_function": {"gaussians": [
        {"channels": ["value", "gradient_magnitude"], "center": [0.5, 1],
         "covariance": [[0.03, 0.01], [0.01, 0.2]], "extinction": 3, "color": [1, 0.5, 0.2]},
        {"channels": ["value"], "center": [0.2], "width": [0.1], "extinction": 1,
         "color": [0, 0, 1]}]}})";
  const SceneState state = state_of(layer);
  const Json saved = Json::parse(state.saved());
  for (const Json& gaussian : saved["layers"][0]["transfer_function"]["gaussians"]) {
    EXPECT_TRUE(gaussian.contains("matrix"));
  }
  EXPECT_EQ(render(make_scene(parse_scene(state.saved(), "saved"))).image.pixels,
            render(state.scene()).image.pixels);
}

TEST(SceneState, TheFunctionFromTheDataIsSeenBesideSurfaces) {
  SceneState state = sphere();
  const auto function_of = [&] {
    return std::get<VolumeContent>(state.scene().layers[0].content).transfer_function->points();
  };
  const std::size_t count = function_of().size();
  state.edit(edit_of(0, "isosurfaces", R"([{"value": 0.5}])", 1));
  state.edit(edit_of(0, "transfer_function", red, 2));
  state.set_default_function(0);
  EXPECT_EQ(function_of().size(), count);
  EXPECT_EQ(state.scene().layers[0].isosurfaces.size(), 1U);
  state.undo();
  EXPECT_EQ(function_of().size(), 1U);
}

TEST(SceneState, ReadsAnotherSource) {
  SceneState state = sphere();
  state.edit(edit_of(0, "transfer_function", red, 1));
  const auto volume_of = [&] { return std::get<VolumeContent>(state.scene().layers[0].content); };
  state.set_source(
      0, [](LayerDescription& layer) { layer.field.builtin = "shells"; }, true);
  EXPECT_EQ(volume_of().transfer_function->points().size(), 1U);
  EXPECT_FALSE(state.can_undo());
  const std::string before = state.saved();
  const auto wrong = [](LayerDescription& layer) { layer.field = {"no_such_file.npy", {}, {}, 4}; };
  EXPECT_THROW(state.set_source(0, wrong, true), Error);
  EXPECT_EQ(state.saved(), before);
  state.set_source(
      0, [](LayerDescription& layer) { layer.field.builtin = "ramp"; }, false);
  EXPECT_GT(volume_of().transfer_function->points().size(), 1U);
  EXPECT_EQ(render(make_scene(parse_scene(state.saved(), "saved"))).image.pixels,
            render(state.scene()).image.pixels);
}

TEST(SceneState, IgnoresCamerasWithoutRays) {
  SceneState state = sphere();
  Camera camera = state.scene().camera;
  camera.position = camera.focal_point;
  state.set_camera(camera);
  EXPECT_FALSE(state.scene().camera.position == camera.position);
}

TEST(Handles, FollowTheMouse) {
  SceneState state = sphere();
  state.edit(edit_of({}, "clip", R"([{"box": {"lower": [-1, -1, -1], "upper": [1, 1, 1]}},
      {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}},
      {"sphere": {"center": [0, 0, 0], "radius": 0.5}},
      {"cylinder": {"start": [0, 0, -1], "end": [0, 0, 1], "radius": 0.5}}])",
                     1));
  const Json overlay = overlay_json(state.scene(), {});
  ASSERT_EQ(overlay["clips"].size(), 4U);
  const PictureMap map(state.scene());
  for (std::size_t c = 0; c < 4; ++c) {
    for (const Json& handle : overlay["clips"][c]["handles"]) {
      const std::string name = handle["name"];
      // Outwards from the middle of the picture, which moves each of them.
      const double x = (handle["x"].get<double>() - 0.5) * map.aspect();
      const double y = handle["y"].get<double>() - 0.5;
      const double reach = std::max(std::hypot(x, y), 0.1);
      const DragHandle drag{c, name, 0.02 * (x + 0.01) / reach, 0.02 * (y + 0.01) / reach, 2};
      state.set_clips(with_handle_dragged(state.scene(), drag), 2);
      const Json after = overlay_json(state.scene(), {});
      for (const Json& moved : after["clips"][c]["handles"]) {
        if (moved["name"] != name) continue;
        const double dx = (moved["x"].get<double>() - handle["x"].get<double>()) * map.aspect();
        const double dy = moved["y"].get<double>() - handle["y"].get<double>();
        EXPECT_GT(dx * drag.x + dy * drag.y, 0) << c << name;
      }
      state.undo();
    }
  }
  EXPECT_THROW(with_handle_dragged(state.scene(), {4, "x0", 0, 0, 1}), Error);
  EXPECT_THROW(with_handle_dragged(state.scene(), {0, "w0", 0, 0, 1}), Error);
  EXPECT_THROW(with_handle_dragged(state.scene(), {1, "x0", 0, 0, 1}), Error);
}

}  // namespace
}  // namespace pellucid::view::scene_state_test
