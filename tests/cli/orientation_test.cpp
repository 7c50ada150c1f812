// SPDX-License-Identifier: Apache-2.0
#include "info/orientation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

using pellucid::Mat3;
using pellucid::cli::anatomical_orientation;

TEST(Orientation, NamesWhereTheAxesGrow) {
  EXPECT_EQ(anatomical_orientation(Mat3<double>{}).code, "LPS");
  EXPECT_EQ(anatomical_orientation({{{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}}}).code, "RAS");
  EXPECT_EQ(anatomical_orientation({{{0, 1, 0}, {0, 0, -1}, {-1, 0, 0}}}).code, "PIR");
  EXPECT_EQ(anatomical_orientation({{{0, 0, 1}, {0, -1, 0}, {-1, 0, 0}}}).code, "SAR");
  EXPECT_EQ(anatomical_orientation(Mat3<double>{}).oblique_by, 0);
}

TEST(Orientation, SaysHowOblique) {
  const double angle = 20 * std::numbers::pi / 180;
  const double c = std::cos(angle), s = std::sin(angle);
  const auto orientation = anatomical_orientation({{{c, s, 0}, {-s, c, 0}, {0, 0, 1}}});
  EXPECT_EQ(orientation.code, "LPS");
  EXPECT_NEAR(orientation.oblique_by, 20, 1e-12);
}

// Two axes that are nearest to the same direction of the world still get two names.
TEST(Orientation, UsesNoWorldAxisTwice) {
  EXPECT_EQ(anatomical_orientation({{{1, 0, 0}, {0.8, 0.6, 0}, {0, 0, 1}}}).code, "LPS");
  EXPECT_EQ(anatomical_orientation({{{0.8, -0.6, 0}, {1, 0, 0}, {0, 0, 1}}}).code, "ALS");
}

}  // namespace
