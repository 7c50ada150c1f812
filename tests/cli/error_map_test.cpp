// SPDX-License-Identifier: Apache-2.0
#include "render/error_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using pellucid::Image;
using pellucid::cli::error_picture;
using pellucid::cli::error_scale;

using Pixel = std::array<float, 4>;
constexpr Pixel red = {1, 0, 0, 1};

Image image_of(std::vector<float> errors, bool proved) {
  Image image;
  image.width = static_cast<int>(errors.size());
  image.height = 1;
  image.pixels.resize(errors.size());
  image.proved.assign(errors.size(), proved ? 1 : 0);
  image.error = std::move(errors);
  return image;
}

double luminance(const Pixel& p) {
  return 0.2126 * static_cast<double>(p[0]) + 0.7152 * static_cast<double>(p[1]) +
         0.0722 * static_cast<double>(p[2]);
}

// IEC 61966-2-1.
int signal(float linear) {
  const double x = static_cast<double>(linear);
  const double s = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
  return static_cast<int>(std::lround(255 * s));
}

TEST(ErrorPicture, EndsAndMiddleAreThoseOfViridis) {
  const Image picture = error_picture(image_of({0, 0.25F, 0.5F}, true), 0.5);
  const int expected[3][3] = {{68, 1, 84}, {33, 145, 140}, {253, 231, 37}};
  for (int x = 0; x < 3; ++x) {
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(signal(picture.at(x, 0)[c]), expected[x][c]) << x << ' ' << c;
    }
    EXPECT_EQ(picture.at(x, 0)[3], 1);
  }
}

// Perceptually ordered: the larger the error the brighter, with and without a proof.
TEST(ErrorPicture, GrowsBrighterWithTheError) {
  std::vector<float> errors;
  for (int i = 0; i <= 1000; ++i) errors.push_back(1e-3F * static_cast<float>(i) * 1e-3F);
  const Image proved = error_picture(image_of(errors, true), 1e-3);
  const Image estimated = error_picture(image_of(errors, false), 1e-3);
  double before = -1;
  for (int x = 0; x <= 1000; ++x) {
    const double bright = luminance(proved.at(x, 0));
    EXPECT_GT(bright, before) << x;
    before = bright;
    // CIE lightness, from that of the dark end to that of the bright one, grows evenly.
    EXPECT_NEAR(116 * std::cbrt(bright) - 16, 15 + 0.076 * x, 2) << x;
    // In grey of the same luminance.
    EXPECT_NEAR(luminance(estimated.at(x, 0)), bright, 1e-6);
    EXPECT_EQ(estimated.at(x, 0)[0], estimated.at(x, 0)[1]);
    EXPECT_EQ(estimated.at(x, 0)[0], estimated.at(x, 0)[2]);
    EXPECT_NE(proved.at(x, 0), estimated.at(x, 0));
  }
}

TEST(ErrorPicture, IsRedWhereOverOrUnknown) {
  constexpr float infinite = std::numeric_limits<float>::infinity();
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  for (const bool proved : {false, true}) {
    for (const float over : {1.001e-3F, 1.0F, infinite, nan}) {
      EXPECT_EQ(error_picture(image_of({over}, proved), 1e-3).at(0, 0), red) << over;
    }
    // 1e-3 is larger in binary32 than in binary64, and not over.
    ASSERT_GT(static_cast<double>(1e-3F), 1e-3);
    EXPECT_NE(error_picture(image_of({1e-3F}, proved), 1e-3).at(0, 0), red);
    EXPECT_NE(error_picture(image_of({0}, proved), 1e-3).at(0, 0), red);
  }
}

TEST(ErrorPicture, ScaleNamesTheTolerance) {
  EXPECT_NE(error_scale(1.0 / 512).find("0.001953125"), std::string::npos);
}

}  // namespace
