// SPDX-License-Identifier: Apache-2.0
#include "difference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pellucid/scene/error.h"

namespace {

using pellucid::Image;
using pellucid::cli::compare_images;
using pellucid::cli::difference_image;
using pellucid::cli::difference_picture;

Image grey(int width, int height, float value) {
  Image image;
  image.width = width;
  image.height = height;
  image.pixels.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                      {value, value, value, 1});
  return image;
}

TEST(Difference, OfAnImageWithItselfIsNothing) {
  const Image a = grey(5, 3, 0.25F);
  const auto d = compare_images(a, a);
  EXPECT_EQ(d.all.largest, 0);
  EXPECT_EQ(d.all.root_mean_square, 0);
  EXPECT_EQ(d.all.percentile_999, 0);
  EXPECT_EQ(d.all.psnr, std::numeric_limits<double>::infinity());
  EXPECT_EQ(d.all.values, 60U);
}

TEST(Difference, FindsTheLargest) {
  const Image a = grey(4, 3, 0.25F);
  Image b = a;
  b.at(2, 1)[1] = 0.75F;
  b.at(3, 2)[3] = 0.75F;
  const auto d = compare_images(a, b);
  EXPECT_EQ(d.all.largest, 0.5);
  EXPECT_EQ(d.column, 2);
  EXPECT_EQ(d.row, 1);
  EXPECT_EQ(d.channel[0].largest, 0);
  EXPECT_EQ(d.channel[1].largest, 0.5);
  EXPECT_EQ(d.channel[3].largest, 0.25);
  // By hand: 48 numbers, squares 1/4 and 1/16.
  EXPECT_DOUBLE_EQ(d.all.root_mean_square, std::sqrt((0.25 + 0.0625) / 48));
  EXPECT_DOUBLE_EQ(d.all.psnr, -10 * std::log10((0.25 + 0.0625) / 48));
}

TEST(Difference, PercentileIsTheNearestRank) {
  // 4000 numbers: four of them may exceed the 99.9th percentile.
  const Image a = grey(1000, 1, 0);
  for (const int differing : {4, 5}) {
    Image b = a;
    for (int i = 0; i < differing; ++i) b.at(7 * i, 0)[0] = 1;
    EXPECT_EQ(compare_images(a, b).all.percentile_999, differing == 4 ? 0 : 1);
  }
}

TEST(Difference, CountsWhatIsNotFinite) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  constexpr float infinite = std::numeric_limits<float>::infinity();
  Image a = grey(2, 2, 0), b = a;
  a.at(0, 0)[0] = b.at(0, 0)[0] = nan;
  a.at(0, 0)[1] = b.at(0, 0)[1] = infinite;
  EXPECT_EQ(compare_images(a, b).all.not_finite, 0U);
  b.at(1, 0)[2] = 0.5F;
  a.at(1, 1)[0] = nan;
  a.at(1, 1)[1] = infinite;
  const auto d = compare_images(a, b);
  EXPECT_EQ(d.all.not_finite, 2U);
  EXPECT_EQ(d.all.largest, 0.5);
  EXPECT_EQ(d.column, 1);
  EXPECT_EQ(d.row, 1);
  EXPECT_TRUE(std::isnan(difference_image(a, b).at(1, 1)[0]));
  EXPECT_EQ(difference_picture(a, b, 1).at(1, 1)[0], 1);
}

TEST(Difference, PictureIsScaledAndOpaque) {
  const Image a = grey(2, 1, 0.5F);
  Image b = a;
  b.at(1, 0)[3] = 0.75F;
  const Image picture = difference_picture(a, b, 2);
  EXPECT_EQ(picture.at(0, 0), (std::array<float, 4>{0, 0, 0, 1}));
  EXPECT_EQ(picture.at(1, 0), (std::array<float, 4>{0.5F, 0.5F, 0.5F, 1}));
  EXPECT_EQ(difference_picture(a, b, 100).at(1, 0)[0], 1);
}

TEST(Difference, RefusesOtherSizes) {
  EXPECT_THROW(compare_images(grey(2, 3, 0), grey(3, 2, 0)), pellucid::Error);
}

}  // namespace
