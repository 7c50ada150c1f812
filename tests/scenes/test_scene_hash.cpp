// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "scene/scene_fields.h"
#include "tests/scenes/makers.h"
#include "tests/scenes/scene_hash.h"

/// The hash of a scene chooses its kept reference: a field that it leaves out would take that of
/// another scene. Every field of the tables of keys is changed here.
namespace pellucid::scenes {
namespace {

using scene_fields::Choice;
using scene_fields::Color;
using scene_fields::Colors;
using scene_fields::Number;
using scene_fields::Vector;

std::shared_ptr<const TransferFunction> function(double red) {
  return std::make_shared<const TransferFunction>(
      std::vector<TransferFunction::Point>{{0, 0, {red, 0, 0}}, {1, 2, {red, 1, 1}}});
}

/// Changes one field of a part, and tells its name.
class Change {
 public:
  explicit Change(int field) : field_(field) {}

  template <class Member, class Kind>
  void operator()(const scene_fields::Key& key, Member& member, const Kind&) {
    if (seen_++ != field_) return;
    name = key.name;
    if constexpr (std::is_same_v<Kind, Number>) {
      if constexpr (std::is_same_v<Member, std::optional<double>>) {
        member = member.value_or(0) + 0.125;
      } else {
        member += 0.125;
      }
    } else if constexpr (std::is_same_v<Kind, Vector>) {
      member.y += 0.125;
    } else if constexpr (std::is_same_v<Kind, Color>) {
      member.g += 0.125;
    } else if constexpr (std::is_same_v<Kind, Choice>) {
      member = static_cast<Member>(1 - static_cast<int>(member));
    } else if constexpr (std::is_same_v<Kind, Colors>) {
      member.colors = function(0.125);
    } else {
      static_assert(std::is_same_v<Kind, scene_fields::Channel>);
      member = member.index() + 1;
    }
  }

  std::string name;

 private:
  int field_, seen_ = 0;
};

Scene full_scene() {
  Scene scene;
  scene.size = {8, 6};
  Layer layer(VolumeContent{builtin("sphere", 4), function(0.5)});
  layer.shading = Shading{};
  layer.isosurfaces = {Isosurface{}};
  layer.slices = {Slice{}};
  scene.layers = {std::move(layer)};
  scene.clips = {{ClipPlane{}}, {ClipBox{}}, {ClipSphere{}}, {ClipCylinder{}}};
  scene.lights = {Light{}, {DirectionalLight{}, {}}, {PointLight{}, {}}};
  return scene;
}

/// Expects another hash after a change of each field of the part that `part` finds in a scene.
template <class Find>
void expect_all_count(const std::string& what, int fields, const Find& part) {
  const std::uint64_t before = scene_hash(full_scene());
  int changed = 0;
  for (int field = 0;; ++field) {
    Scene scene = full_scene();
    Change change(field);
    scene_fields::visit_fields(part(scene), [&](const scene_fields::Key& key, auto& member,
                                                const auto& kind) { change(key, member, kind); });
    if (change.name.empty()) break;
    ++changed;
    EXPECT_NE(scene_hash(scene), before) << what << "." << change.name;
  }
  EXPECT_EQ(changed, fields) << what;
}

TEST(SceneHashOfFields, DependsOnEveryFieldOfTheCamera) {
  expect_all_count("camera", 6, [](Scene& s) -> Camera& { return s.camera; });
}

TEST(SceneHashOfFields, DependsOnEveryFieldOfALayersParts) {
  expect_all_count("shading", 8, [](Scene& s) -> Shading& { return *s.layers[0].shading; });
  expect_all_count("isosurface", 6,
                   [](Scene& s) -> Isosurface& { return s.layers[0].isosurfaces[0]; });
  expect_all_count("slice", 5, [](Scene& s) -> Slice& { return s.layers[0].slices[0]; });
}

TEST(SceneHashOfFields, DependsOnEveryFieldOfLightsAndClips) {
  for (const int i : {0, 1, 2}) {
    expect_all_count("light", 1,
                     [i](Scene& s) -> Light& { return s.lights[static_cast<std::size_t>(i)]; });
  }
  expect_all_count("directional", 1, [](Scene& s) -> DirectionalLight& {
    return std::get<DirectionalLight>(s.lights[1].kind);
  });
  expect_all_count("point", 1,
                   [](Scene& s) -> PointLight& { return std::get<PointLight>(s.lights[2].kind); });
  expect_all_count("plane", 2,
                   [](Scene& s) -> ClipPlane& { return std::get<ClipPlane>(s.clips[0].shape); });
  expect_all_count("box", 2,
                   [](Scene& s) -> ClipBox& { return std::get<ClipBox>(s.clips[1].shape); });
  expect_all_count("sphere", 2,
                   [](Scene& s) -> ClipSphere& { return std::get<ClipSphere>(s.clips[2].shape); });
  expect_all_count("cylinder", 3, [](Scene& s) -> ClipCylinder& {
    return std::get<ClipCylinder>(s.clips[3].shape);
  });
}

TEST(SceneHashOfFields, DependsOnWhatHasNoTable) {
  const std::uint64_t before = scene_hash(full_scene());
  const std::vector<std::function<void(Scene&)>> changes{
      [](Scene& s) { s.size.width = 9; },
      [](Scene& s) { s.samples = 2; },
      [](Scene& s) { s.clips[0].keep_inside = !s.clips[0].keep_inside; },
      [](Scene& s) { s.layers[0].visible = false; },
      [](Scene& s) { s.layers[0].projection = LayerProjection::maximum; },
      [](Scene& s) { s.layers[0].transform.translation.x = 1; },
      [](Scene& s) { s.layers[0].clips = {{ClipSphere{}}}; },
      [](Scene& s) {
        std::get<VolumeContent>(s.layers[0].content).transfer_function = function(0.25);
      },
      [](Scene& s) { std::get<VolumeContent>(s.layers[0].content).volume = builtin("ramp", 4); }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Scene scene = full_scene();
    changes[i](scene);
    EXPECT_NE(scene_hash(scene), before) << i;
  }
  EXPECT_EQ(scene_hash(full_scene()), before);
}

}  // namespace
}  // namespace pellucid::scenes
