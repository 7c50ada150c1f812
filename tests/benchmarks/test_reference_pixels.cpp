// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "benchmarks/frames/reference_pixels.h"
#include "pellucid/reference/render.h"
#include "tests/scenes/peers.h"

namespace pellucid::bench::test_reference_pixels {
namespace {

TEST(ChosenPixels, AreAllOfASmallImage) {
  const auto list = chosen_pixels({4, 3}, 100);
  ASSERT_EQ(list.size(), 12U);
  EXPECT_EQ(list.front(), 0U);
  EXPECT_EQ(list.back(), 11U);
}

TEST(ChosenPixels, AreARowAColumnAndOthersEachOnce) {
  const auto list = chosen_pixels({64, 48}, 500);
  EXPECT_EQ(list, chosen_pixels({64, 48}, 500));
  EXPECT_EQ(list.size(), 500U);
  const std::set<std::size_t> once(list.begin(), list.end());
  EXPECT_EQ(once.size(), list.size());
  EXPECT_LT(*once.rbegin(), 64U * 48U);
  for (std::size_t x = 0; x < 64; ++x) EXPECT_TRUE(once.contains(18 * 64 + x)) << x;
  for (std::size_t y = 0; y < 48; ++y) EXPECT_TRUE(once.contains(y * 64 + 40)) << y;
}

TEST(ReferencePixels, AreThoseOfTheReferenceImage) {
  Scene scene = scenes::make_scene(scenes::builtin("marschner_lobb", 17), scenes::band_transfer(),
                                   scenes::view_camera(scenes::View::oblique), {12, 9});
  scene.samples = 2;
  const Image image = render_reference(scene).image;
  const ReferencePixels pixels = reference_pixels(scene, 40, 2, {});
  ASSERT_EQ(pixels.value.size(), 40U);
  EXPECT_LT(error_of(image, pixels).largest, 1.2e-7);  // the image is rounded to float
}

TEST(ReferencePixels, ErrorsAreOfTheChosenPixelsAndAllChannels) {
  Image image;
  image.width = 2;
  image.height = 1;
  image.pixels = {{0, 0, 0, 0}, {1, 1, 1, 1}};
  ReferencePixels reference{{1}, {{1, 1, 1, 0.5}}};
  EXPECT_DOUBLE_EQ(error_of(image, reference).largest, 0.5);
  EXPECT_DOUBLE_EQ(error_of(image, reference).rms, 0.25);
  image.pixels[1][2] = NAN;
  EXPECT_TRUE(std::isinf(error_of(image, reference).largest));
}

}  // namespace
}  // namespace pellucid::bench::test_reference_pixels
