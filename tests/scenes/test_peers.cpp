// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/scenes/compare.h"

/// The exact method against the reference on the scenes that other renderers were measured on.
namespace pellucid::scenes {
namespace {

void expect_all_exact(const std::vector<NamedScene>& list) {
  for (const NamedScene& named : list) expect_exact(named);
}

TEST(PeerScenes, MarschnerLobb) {
  expect_all_exact(marschner_lobb_scenes(128, {32, 32}));
}

TEST(PeerScenes, RaySplittingAndItsThinSweep) {
  for (const double upper : {.74, .6563, .582, .5161, .4577, .4059, .36}) {
    expect_exact(ray_splitting_scene(128, {36, 36}, upper));
  }
}

TEST(PeerScenes, Sphere) {
  expect_all_exact(sphere_scenes(129, {41, 37}));
}

TEST(PeerScenes, Torture) {
  expect_all_exact(torture_scenes(65, {33, 32}));
}

}  // namespace
}  // namespace pellucid::scenes
