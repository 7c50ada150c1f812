// SPDX-License-Identifier: Apache-2.0

// The tables of fields (scene_fields.h): every field is written, read back and in the schema.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <variant>

#include "scene/read_fields.h"

namespace pellucid::test_scene_fields {
namespace {

using Keys = std::set<std::string>;

template <class Part>
Keys keys_of(const Part& part) {
  const std::vector<std::string_view> names = scene_json::keys_of(part);
  return {names.begin(), names.end()};
}

Keys keys_of(const nlohmann::json& schema) {
  Keys keys;
  for (const auto& [key, value] : schema.at("properties").items()) keys.insert(key);
  return keys;
}

TEST(SceneFields, AreThoseOfTheSchema) {
  std::ifstream file(std::string(PELLUCID_SOURCE_DIR) + "/docs/reference/scene.schema.json");
  const nlohmann::json schema = nlohmann::json::parse(file);
  const nlohmann::json& parts = schema.at("$defs");
  EXPECT_EQ(keys_of(Shading{}), keys_of(parts.at("shading")));
  EXPECT_EQ(keys_of(Isosurface{}), keys_of(parts.at("isosurface")));
  EXPECT_EQ(keys_of(Slice{}), keys_of(parts.at("slice")));
  EXPECT_EQ(keys_of(Camera{}), keys_of(parts.at("camera")));
  EXPECT_EQ(keys_of(Integration{}), keys_of(schema.at("properties").at("integration")));
  Keys light = keys_of(Light{});
  light.insert("type");
  light.merge(keys_of(DirectionalLight{}));
  light.merge(keys_of(PointLight{}));
  EXPECT_EQ(light, keys_of(parts.at("light")));
  const nlohmann::json& clip = parts.at("clip").at("properties");
  EXPECT_EQ(keys_of(ClipPlane{}), keys_of(clip.at("plane")));
  EXPECT_EQ(keys_of(ClipBox{}), keys_of(clip.at("box")));
  EXPECT_EQ(keys_of(ClipSphere{}), keys_of(clip.at("sphere")));
  EXPECT_EQ(keys_of(ClipCylinder{}), keys_of(clip.at("cylinder")));
}

/// Gives each field a value of its own, which is not its default.
class Fill {
 public:
  template <class Member>
  void operator()(const scene_fields::Key&, Member& member,
                  const scene_fields::Number& kind) const {
    member = std::max(kind.least, 0.5) + next() / 1024;
  }
  void operator()(const scene_fields::Key&, std::optional<double>& member,
                  const scene_fields::InPlace&) const {
    member = next() / 1024;
  }
  void operator()(const scene_fields::Key&, Vec3<double>& member, const auto&) const {
    member = {next(), 0.5, 2};
  }
  void operator()(const scene_fields::Key&, Rgb<double>& member, const auto&) const {
    member = {next(), 0.5, 2};
  }
  template <class Enum>
  void operator()(const scene_fields::Key&, Enum& member, const scene_fields::Choice& kind) const {
    member = static_cast<Enum>(kind.names.size() - 1);
  }
  void operator()(const scene_fields::Key&, ChannelRef& member,
                  const scene_fields::Channel&) const {
    member = "b";
  }
  template <class Surface>
  void operator()(const scene_fields::Key&, Surface& member, const scene_fields::Colors&) const {
    member.colors = std::make_shared<const TransferFunction>(
        std::vector<TransferFunction::Point>{{next(), 0, {0, 1, 0}}});
  }

 private:
  double next() const { return ++*count_; }

  std::shared_ptr<double> count_ = std::make_shared<double>(0);
};

template <class Part>
Part filled(Part part = {}) {
  scene_fields::visit_fields(part, Fill());
  return part;
}

TEST(SceneFields, AreWrittenAndReadBack) {
  SceneDescription scene;
  LayerDescription& layer = scene.layers[0];
  layer.channels = {{"a", "", parse_field_source("builtin:ramp:4")},
                    {"b", "", parse_field_source("builtin:sphere:4")}};
  layer.shading = filled<Shading>();
  layer.shading->flatness.reset();
  layer.isosurfaces = {filled<Isosurface>(), filled<Isosurface>()};
  layer.isosurfaces[1].value = 7;
  layer.isosurfaces[1].colors.reset();
  layer.slices = {filled<Slice>()};
  scene.layers.push_back(layer);
  scene.layers[1].shading = filled<Shading>();
  scene.layers[1].shading->flat_gradient.reset();
  scene.lights = {filled(Light{filled<DirectionalLight>()}), filled(Light{filled<PointLight>()})};
  scene.clips = {{filled<ClipPlane>(), false},
                 {ClipBox{{-1, -2, -3}, {4, 5, 6}}},
                 {filled<ClipSphere>()},
                 {filled<ClipCylinder>()}};
  scene.camera = filled<Camera>();
  ASSERT_EQ(scene.camera->projection, Projection::orthographic);
  scene.integration = filled<Integration>();

  const std::string text = scene_to_json(scene);
  EXPECT_EQ(scene_to_json(parse_scene(text, "written")), text);
  Keys keys = keys_of(Shading{});
  for (const Keys& more :
       {keys_of(Isosurface{}), keys_of(Slice{}), keys_of(DirectionalLight{}), keys_of(PointLight{}),
        keys_of(Light{}), keys_of(ClipPlane{}), keys_of(ClipBox{}), keys_of(ClipSphere{}),
        keys_of(ClipCylinder{}), keys_of(Camera{}), keys_of(Integration{})}) {
    keys.insert(more.begin(), more.end());
  }
  keys.erase("vertical_angle");  // of the other kind of camera
  keys.erase("tolerance");       // a share is there in its place
  for (const std::string& key : keys) {
    EXPECT_NE(text.find("\"" + key + "\": "), std::string::npos) << key;
  }
}

}  // namespace
}  // namespace pellucid::test_scene_fields
