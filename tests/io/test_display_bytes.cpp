// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "pellucid/io/display_bytes.h"
#include "pellucid/scene/srgb.h"

namespace pellucid::test_display_bytes {
namespace {

int rounded(double linear) {
  return static_cast<int>(std::lround(255 * linear_to_srgb(std::clamp(linear, 0.0, 1.0))));
}

Image random_image(int width, int height) {
  Image image{width, height, {}, {}, {}, {}, {}, {}};
  std::mt19937 random(7);
  std::uniform_real_distribution<float> number(-0.1F, 1.2F);
  for (int i = 0; i < width * height; ++i) {
    // Squared, so that dark pixels are as frequent as their signals.
    const float alpha = number(random), light = number(random);
    image.pixels.push_back({light * light, number(random), light * 0.01F, alpha});
  }
  return image;
}

TEST(DisplayBytes, AreTheRoundedSignalsOverTheBackground) {
  const Image image = random_image(400, 300);
  const Rgb<double> background{0.1, 0.5, 1.5};
  const std::vector<std::uint8_t> bytes = display_bytes(image, background, DisplayLayout::rgba);
  ASSERT_EQ(bytes.size(), image.pixels.size() * 4);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const auto& pixel = image.pixels[i];
    const double rest = 1 - std::clamp(static_cast<double>(pixel[3]), 0.0, 1.0);
    ASSERT_EQ(bytes[4 * i], rounded(static_cast<double>(pixel[0]) + rest * background.r));
    ASSERT_EQ(bytes[4 * i + 1], rounded(static_cast<double>(pixel[1]) + rest * background.g));
    ASSERT_EQ(bytes[4 * i + 2], rounded(static_cast<double>(pixel[2]) + rest * background.b));
    ASSERT_EQ(bytes[4 * i + 3], 255);
  }
}

TEST(DisplayBytes, RoundEachSignalToItself) {
  Image image{256, 1, {}, {}, {}, {}, {}, {}};
  for (int code = 0; code < 256; ++code) {
    const auto light = static_cast<float>(srgb_to_linear(code / 255.0));
    image.pixels.push_back({light, light, light, 1});
  }
  const std::vector<std::uint8_t> opaque = display_bytes(image, {});
  const std::vector<std::uint8_t> transparent = transparent_display_bytes(image);
  for (std::size_t code = 0; code < 256; ++code) {
    EXPECT_EQ(opaque[3 * code], code);
    EXPECT_EQ(transparent[4 * code], code);
  }
}

TEST(DisplayBytes, TakeEveryNthPixel) {
  Image image = random_image(10, 7);
  const std::vector<std::uint8_t> all = display_bytes(image, {}, DisplayLayout::rgb);
  const std::vector<std::uint8_t> some = display_bytes(ImageView(image), {}, DisplayLayout::rgb, 4);
  ASSERT_EQ(some.size(), 3U * 2U * 3U);
  for (std::size_t j = 0; j < 2; ++j) {
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(some[3 * (j * 3 + i)], all[3 * (4 * j * 10 + 4 * i)]);
    }
  }
}

}  // namespace
}  // namespace pellucid::test_display_bytes
