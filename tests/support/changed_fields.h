// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "scene/scene_fields.h"
#include "tests/scenes/makers.h"

/// A scene with parts of all kinds, and a change of each of its fields: for what must tell scenes
/// apart, whatever field they differ in.
namespace pellucid::scenes {

using Differs = std::function<bool(const Scene& changed, const Scene& before)>;

inline std::shared_ptr<const TransferFunction> function(double red) {
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
    if constexpr (std::is_same_v<Kind, scene_fields::Number>) {
      change_number(member);
    } else if constexpr (std::is_same_v<Kind, scene_fields::InPlace>) {
      change_number(member);
    } else if constexpr (std::is_same_v<Kind, scene_fields::Vector>) {
      member.y += 0.125;
    } else if constexpr (std::is_same_v<Kind, scene_fields::Color>) {
      member.g += 0.125;
    } else if constexpr (std::is_same_v<Kind, scene_fields::Choice>) {
      member = static_cast<Member>(1 - static_cast<int>(member));
    } else if constexpr (std::is_same_v<Kind, scene_fields::Colors>) {
      member.colors = function(0.125);
    } else {
      static_assert(std::is_same_v<Kind, scene_fields::Channel>);
      member = member.index() + 1;
    }
  }

  std::string name;

 private:
  static void change_number(double& number) { number += 0.125; }
  static void change_number(std::optional<double>& number) { number = number.value_or(0) + 0.125; }

  int field_, seen_ = 0;
};

inline Scene full_scene() {
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

/// Expects a difference after a change of each field of the part that `part` finds in a scene.
template <class Find>
void expect_fields_differ(const Differs& differs, const std::string& what, int fields,
                          const Find& part) {
  const Scene before = full_scene();
  int changed = 0;
  for (int field = 0;; ++field) {
    Scene scene = full_scene();
    Change change(field);
    scene_fields::visit_fields(part(scene), [&](const scene_fields::Key& key, auto& member,
                                                const auto& kind) { change(key, member, kind); });
    if (change.name.empty()) break;
    ++changed;
    EXPECT_TRUE(differs(scene, before)) << what << "." << change.name;
  }
  EXPECT_EQ(changed, fields) << what;
}

/// Expects a difference after a change of each field of the camera, of a layer's parts, of lights
/// and of clips.
inline void expect_all_fields_differ(const Differs& differs) {
  const auto expect = [&](const std::string& what, int fields, const auto& part) {
    expect_fields_differ(differs, what, fields, part);
  };
  expect("camera", 6, [](Scene& s) -> Camera& { return s.camera; });
  expect("shading", 8, [](Scene& s) -> Shading& { return *s.layers[0].shading; });
  expect("isosurface", 6, [](Scene& s) -> Isosurface& { return s.layers[0].isosurfaces[0]; });
  expect("slice", 5, [](Scene& s) -> Slice& { return s.layers[0].slices[0]; });
  for (const int i : {0, 1, 2}) {
    expect("light", 1, [i](Scene& s) -> Light& { return s.lights[static_cast<std::size_t>(i)]; });
  }
  expect("directional", 1, [](Scene& s) -> DirectionalLight& {
    return std::get<DirectionalLight>(s.lights[1].kind);
  });
  expect("point", 1,
         [](Scene& s) -> PointLight& { return std::get<PointLight>(s.lights[2].kind); });
  expect("plane", 2, [](Scene& s) -> ClipPlane& { return std::get<ClipPlane>(s.clips[0].shape); });
  expect("box", 2, [](Scene& s) -> ClipBox& { return std::get<ClipBox>(s.clips[1].shape); });
  expect("sphere", 2,
         [](Scene& s) -> ClipSphere& { return std::get<ClipSphere>(s.clips[2].shape); });
  expect("cylinder", 3,
         [](Scene& s) -> ClipCylinder& { return std::get<ClipCylinder>(s.clips[3].shape); });
}

}  // namespace pellucid::scenes
