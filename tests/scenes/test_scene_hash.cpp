// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "tests/scenes/scene_hash.h"
#include "tests/support/changed_fields.h"

/// The hash of a scene chooses its kept reference: a field that it leaves out would take that of
/// another scene. Every field of the tables of keys is changed here.
namespace pellucid::scenes {
namespace {

TEST(SceneHashOfFields, DependsOnEveryFieldOfTheTables) {
  expect_all_fields_differ([](const Scene& changed, const Scene& before) {
    return scene_hash(changed) != scene_hash(before);
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
