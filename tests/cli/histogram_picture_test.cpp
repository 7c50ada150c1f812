// SPDX-License-Identifier: Apache-2.0
#include "charts/histogram_picture.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

#include "charts/canvas.h"
#include "charts/colors.h"

namespace {

using pellucid::Image;
using pellucid::JointHistogram;
using pellucid::cli::Canvas;
using pellucid::cli::histogram_picture;
using pellucid::cli::text_width;
using pellucid::cli::viridis_at;

using Pixel = std::array<float, 4>;

Pixel pixel(const std::array<double, 3>& linear) {
  return {static_cast<float>(linear[0]), static_cast<float>(linear[1]),
          static_cast<float>(linear[2]), 1};
}

int count(const Image& image, const Pixel& wanted) {
  int found = 0;
  for (const Pixel& p : image.pixels) found += p == wanted ? 1 : 0;
  return found;
}

TEST(Canvas, DrawsTextInItsPlace) {
  Canvas canvas(40, 20, {255, 255, 255});
  canvas.text(2, 3, "|", {0, 0, 0});
  // One column of seven squares, the third of five.
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 40; ++x) {
      const bool black = (x == 6 || x == 7) && y >= 3 && y < 17;
      EXPECT_EQ(canvas.image().at(x, y)[0], black ? 0.0F : 1.0F) << x << ", " << y;
    }
  }
  EXPECT_EQ(text_width("ab"), 22);
}

TEST(Canvas, LeavesOutWhatIsOutside) {
  Canvas canvas(10, 10, {255, 255, 255});
  canvas.text(-50, -50, "far", {0, 0, 0});
  canvas.text(1000, 4, "\xc3\xa4", {0, 0, 0});
  canvas.fill({-5, 8, 100, 100}, {0, 0, 0});
  EXPECT_EQ(count(canvas.image(), {0, 0, 0, 1}), 20);
}

TEST(HistogramPicture, HasASquareForEachBin) {
  JointHistogram histogram;
  histogram.axes = {{0, 4, 4}, {0, 2, 2}};
  histogram.count = {0, 1, 0, 100, 0, 0, 0, 10};
  const Image image = histogram_picture(histogram, {"x", "y"});
  // 512 pixels in 4 and in 2 bins.
  const int area = 128 * 256;
  // 1, 10 and 100 of at most 100: by hand log(2), log(11), log(101) over log(101).
  for (const double c : {1.0, 10.0, 100.0}) {
    const Pixel wanted = pixel(viridis_at(1 - std::log(1 + c) / std::log(101)));
    const int found = count(image, wanted);
    EXPECT_GE(found, area) << c;
    EXPECT_LT(found, area + 200) << c;  // of the scale beside it
  }
}

TEST(HistogramPicture, SecondAxisGoesUpwards) {
  JointHistogram histogram;
  histogram.axes = {{0, 1, 1}, {0, 2, 2}};
  histogram.count = {5, 0};
  const Image image = histogram_picture(histogram, {"x", "y"});
  const Pixel dark = pixel(viridis_at(0));
  double mean = 0, found = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (image.at(x, y) != dark) continue;
      mean += y;
      ++found;
    }
  }
  EXPECT_GT(mean / found, image.height / 2);
}

TEST(HistogramPicture, BarsAreLogarithmic) {
  JointHistogram histogram;
  histogram.axes = {{0, 3, 3}};
  histogram.count = {0, 9, 99};
  const Image image = histogram_picture(histogram, {"value"});
  std::map<int, int> heights;  // of bars, by how many columns have it
  const Pixel bar = pixel(
      {pellucid::cli::linear_of(59), pellucid::cli::linear_of(82), pellucid::cli::linear_of(139)});
  for (int x = 0; x < image.width; ++x) {
    int height = 0;
    for (int y = 0; y < image.height; ++y) height += image.at(x, y) == bar ? 1 : 0;
    ++heights[height];
  }
  EXPECT_EQ(heights[384], 171);
  EXPECT_EQ(heights[192], 171);
  EXPECT_EQ(heights.size(), 3U);
}

TEST(HistogramPicture, ShowsAnEmptyOne) {
  JointHistogram histogram;
  histogram.axes = {{0, 1, 5}, {0, 1, 3}};
  histogram.count.assign(15, 0);
  EXPECT_NO_THROW(histogram_picture(histogram, {"a", "b"}));
  histogram.axes.pop_back();
  histogram.count.assign(5, 0);
  EXPECT_NO_THROW(histogram_picture(histogram, {"a name that is longer than the plot is wide"}));
}

}  // namespace
