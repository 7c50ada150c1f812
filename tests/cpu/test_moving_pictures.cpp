// SPDX-License-Identifier: Apache-2.0
#include "pellucid/cpu/internal/moving_pictures.h"

#include <gtest/gtest.h>

namespace pellucid::test_moving_pictures {
namespace {

TEST(MovingPictures, TryBothKindsAndPreferTheFasterOne) {
  MovingPictures moving;
  EXPECT_TRUE(moving.are_sampled(1000, 0.1));
  moving.note(true, 0.1, 1000);
  EXPECT_TRUE(moving.are_sampled(1000, 0.1)) << "exact ones are not known yet";
  moving.note(false, 1, 1000);
  EXPECT_TRUE(moving.are_sampled(1000, 0.1));
  // An exact picture that is there in time is better.
  EXPECT_FALSE(moving.are_sampled(1000, 2));
  // So is one that takes hardly longer.
  moving.note(false, 0.12, 1000);
  EXPECT_FALSE(moving.are_sampled(1000, 0.1));
  // No pixel says nothing.
  moving.note(true, 1, 0);
  EXPECT_FALSE(moving.are_sampled(1000, 0.1));
  moving.note(false, 3, 1000);
  EXPECT_TRUE(moving.are_sampled(1000, 0.1));
}

TEST(MovingPictures, AreOfTheSameScene) {
  Scene scene;
  scene.integration.tolerance = 0.25;
  scene.samples = 2;
  const Scene sampled = sampled_scene(scene);
  EXPECT_EQ(sampled.integration.method, Method::midpoint);
  EXPECT_EQ(sampled.integration.step, 1);
  EXPECT_EQ(sampled.samples, 2);
}

}  // namespace
}  // namespace pellucid::test_moving_pictures
