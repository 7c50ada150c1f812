// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/clip.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "expect_error.h"

namespace pellucid::test_clip {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

template <class Shape>
std::string message(const Shape& shape) {
  std::string of_the_inside;
  for (const bool keep_inside : {true, false}) {
    const std::string text = error_message([&] {
      check_clip({shape, keep_inside}, "layer 2: clip 1");
    });
    if (keep_inside) of_the_inside = text;
    EXPECT_EQ(text, of_the_inside);
  }
  return of_the_inside;
}

TEST(Clip, DefaultsAreShapes) {
  EXPECT_EQ(message(ClipPlane{}), "");
  EXPECT_EQ(message(ClipBox{}), "");
  EXPECT_EQ(message(ClipSphere{}), "");
  EXPECT_EQ(message(ClipCylinder{}), "");
}

TEST(Clip, PlanesHaveAPointAndANormal) {
  EXPECT_EQ(message(ClipPlane{{nan, 0, 0}, {0, 0, 1}}),
            "layer 2: clip 1: point is (nan, 0, 0), but all three must be finite numbers");
  EXPECT_EQ(message(ClipPlane{{0, 0, 0}, {0, -infinity, 0}}),
            "layer 2: clip 1: normal is (0, -inf, 0), but all three must be finite numbers");
  EXPECT_EQ(message(ClipPlane{{1, 2, 3}, {0, 0, 0}}),
            "layer 2: clip 1: normal is (0, 0, 0), but must have a length");
  EXPECT_EQ(message(ClipPlane{{1, 2, 3}, {1.5e308, 1.5e308, 0}}),
            "layer 2: clip 1: normal is (1.5e+308, 1.5e+308, 0), but must have a length");
  for (const double length : {1e-300, 1e-3, 1e3, 1e300}) {
    EXPECT_EQ(message(ClipPlane{{1, 2, 3}, {0, -length, 0}}), "") << length;
  }
}

TEST(Clip, BoxesHoldSomething) {
  EXPECT_EQ(message(ClipBox{{0, nan, 0}, {1, 1, 1}}),
            "layer 2: clip 1: lower is (0, nan, 0), but all three must be finite numbers");
  EXPECT_EQ(message(ClipBox{{0, 0, 0}, {1, 1, infinity}}),
            "layer 2: clip 1: upper is (1, 1, inf), but all three must be finite numbers");
  const std::string reason = " is empty; upper must be larger than lower along each axis";
  EXPECT_EQ(message(ClipBox{{0, 0, 0}, {0, 1, 1}}),
            "layer 2: clip 1: box from (0, 0, 0) to (0, 1, 1)" + reason);
  EXPECT_EQ(message(ClipBox{{0, 2.5, 0}, {1, -1, 1}}),
            "layer 2: clip 1: box from (0, 2.5, 0) to (1, -1, 1)" + reason);
  EXPECT_EQ(message(ClipBox{{0, 0, 1}, {1, 1, 1}}),
            "layer 2: clip 1: box from (0, 0, 1) to (1, 1, 1)" + reason);
  EXPECT_EQ(message(ClipBox{{-1, 0, 1}, {0, 1e-300, 1.5}}), "");
}

TEST(Clip, SpheresHaveARadius) {
  EXPECT_EQ(message(ClipSphere{{0, 0, infinity}, 1}),
            "layer 2: clip 1: center is (0, 0, inf), but all three must be finite numbers");
  EXPECT_EQ(message(ClipSphere{{0, 0, 0}, 0}),
            "layer 2: clip 1: radius is 0, but must be a positive number");
  EXPECT_EQ(message(ClipSphere{{0, 0, 0}, -2.5}),
            "layer 2: clip 1: radius is -2.5, but must be a positive number");
  EXPECT_EQ(message(ClipSphere{{0, 0, 0}, nan}),
            "layer 2: clip 1: radius is nan, but must be a positive number");
  EXPECT_EQ(message(ClipSphere{{0, 0, 0}, infinity}),
            "layer 2: clip 1: radius is inf, but must be a positive number");
}

TEST(Clip, CylindersHaveARadiusAndALength) {
  EXPECT_EQ(message(ClipCylinder{{nan, 0, 0}, {0, 0, 1}, 1}),
            "layer 2: clip 1: start is (nan, 0, 0), but all three must be finite numbers");
  EXPECT_EQ(message(ClipCylinder{{0, 0, 0}, {0, infinity, 1}, 1}),
            "layer 2: clip 1: end is (0, inf, 1), but all three must be finite numbers");
  EXPECT_EQ(message(ClipCylinder{{0, 0, 0}, {0, 0, 1}, 0}),
            "layer 2: clip 1: radius is 0, but must be a positive number");
  EXPECT_EQ(message(ClipCylinder{{1, 2, 3}, {1, 2, 3}, 1}),
            "layer 2: clip 1: end - start is (0, 0, 0), but must have a length");
  EXPECT_EQ(message(ClipCylinder{{0, 0, -1.5e308}, {0, 0, 1.5e308}, 1}),
            "layer 2: clip 1: end - start is (0, 0, inf), but all three must be finite numbers");
  EXPECT_EQ(message(ClipCylinder{{1, 2, 3}, {1, 2, 2}, 1e-9}), "");
}

}  // namespace
}  // namespace pellucid::test_clip
