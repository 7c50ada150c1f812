// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pellucid/scene/error.h"
#include "pellucid/scene/image_difference.h"

namespace {

using pellucid::check_errors;
using pellucid::compare_images;
using pellucid::difference_image;
using pellucid::difference_picture;
using pellucid::Image;
using pellucid::pixels_over;

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

Image with_error(Image image, float error, bool proved = true) {
  image.error.assign(image.pixels.size(), error);
  image.proved.assign(image.pixels.size(), proved ? 1 : 0);
  return image;
}

TEST(CheckErrors, NeedsAnErrorInTheFirstImage) {
  const Image a = grey(2, 2, 0);
  EXPECT_FALSE(check_errors(a, a).has_value());
  EXPECT_FALSE(check_errors(a, with_error(a, 1)).has_value());
  EXPECT_TRUE(check_errors(with_error(a, 1), a).has_value());
}

TEST(CheckErrors, CountsWhatIsOverAndFindsTheWorst) {
  const Image a = with_error(grey(4, 3, 0), 0.125F);
  Image b = grey(4, 3, 0);
  b.at(0, 0)[0] = 0.125F;   // just within
  b.at(1, 2)[3] = 0.75F;    // over, by 0.125 in alpha
  b.at(2, 1)[1] = 0.25F;    // over, by as much
  b.at(3, 1)[2] = -0.375F;  // over, by most
  b.at(0, 2)[2] = 0.0625F;  // within
  const auto check = *check_errors(a, b);
  EXPECT_EQ(check.pixels, 12U);
  EXPECT_EQ(check.over, 3U);
  EXPECT_EQ(check.unknown, 0U);
  EXPECT_EQ(check.proved, 12U);
  EXPECT_EQ(check.column, 3);
  EXPECT_EQ(check.row, 1);
  EXPECT_EQ(check.difference, 0.375);
  EXPECT_EQ(check.error, 0.125);
  // 0.125 / {0.375, 0.25, 0.25, 0.125, 0.0625}; the others do not differ.
  EXPECT_DOUBLE_EQ(check.tightness_median, 0.5);
  EXPECT_DOUBLE_EQ(check.tightness_smallest, 1.0 / 3);
}

TEST(CheckErrors, ErrorsOfBothAreAddedElseTheSecondIsRounded) {
  const Image a = grey(1, 1, 1), b = grey(1, 1, 1 + 0x1p-23F);
  // Alpha is 1 in both; rounding b to binary32 may have cost 2^-24.
  EXPECT_EQ(check_errors(with_error(a, 0x1p-24F), b)->over, 0U);
  EXPECT_EQ(check_errors(with_error(a, 0x1p-25F), b)->over, 1U);
  // An error that b carries has its rounding in it.
  EXPECT_EQ(check_errors(with_error(a, 0x1p-24F), with_error(b, 0x1p-25F))->over, 1U);
  const auto check = *check_errors(with_error(a, 0x1p-24F), with_error(b, 0x1p-24F, false));
  EXPECT_EQ(check.over, 0U);
  EXPECT_EQ(check.proved, 0U);
  EXPECT_DOUBLE_EQ(check.tightness_median, 1);
}

TEST(CheckErrors, NothingDiffers) {
  const Image a = with_error(grey(2, 1, 0.5F), 0.25F);
  const auto check = *check_errors(a, grey(2, 1, 0.5F));
  EXPECT_EQ(check.over, 0U);
  EXPECT_EQ(check.tightness_median, std::numeric_limits<double>::infinity());
  EXPECT_EQ(check.tightness_smallest, std::numeric_limits<double>::infinity());
}

TEST(CheckErrors, WhatIsNotFinite) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  constexpr float infinite = std::numeric_limits<float>::infinity();
  for (const float bad : {nan, infinite, -infinite}) {
    Image a = with_error(grey(3, 1, 0), 0.5F), b = grey(3, 1, 0);
    b.at(1, 0)[0] = bad;
    EXPECT_EQ(check_errors(a, b)->over, 1U) << bad;
    EXPECT_EQ(check_errors(a, b)->column, 1) << bad;
    std::swap(a.pixels, b.pixels);
    EXPECT_EQ(check_errors(a, b)->over, 1U) << bad;
    // The same in both is no difference.
    b.at(1, 0)[0] = bad;
    EXPECT_EQ(check_errors(a, b)->over, 0U) << bad;
    // An error that says nothing is never exceeded, and one below zero always.
    Image unknown = with_error(grey(3, 1, 0), bad);
    const auto check = *check_errors(unknown, b);
    EXPECT_EQ(check.unknown, 3U) << bad;
    EXPECT_EQ(check.over, 0U) << bad;
  }
  EXPECT_EQ(check_errors(with_error(grey(2, 1, 0), -1), grey(2, 1, 0))->over, 2U);
}

TEST(PixelsOver, CountsPixelsNotChannels) {
  const Image a = grey(4, 1, 0);
  Image b = a;
  b.at(0, 0) = {0.5F, 0.5F, 0.5F, 0.5F};
  b.at(1, 0)[3] = 1.25F;
  b.at(2, 0)[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(pixels_over(a, b, 0.49), 2U);
  EXPECT_EQ(pixels_over(a, b, 0.5), 1U);
  EXPECT_EQ(pixels_over(a, b, 0.2499), 3U);
  EXPECT_EQ(pixels_over(a, a, 1e-300), 0U);
}

TEST(Difference, RefusesOtherSizes) {
  EXPECT_THROW(check_errors(grey(2, 3, 0), grey(3, 2, 0)), pellucid::Error);
  EXPECT_THROW(pixels_over(grey(2, 3, 0), grey(3, 2, 0), 1), pellucid::Error);
  EXPECT_THROW(compare_images(grey(2, 3, 0), grey(3, 2, 0)), pellucid::Error);
}

}  // namespace
