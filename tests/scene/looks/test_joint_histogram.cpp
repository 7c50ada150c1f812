// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/joint_histogram.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "tests/scene/expect_error.h"
#include "tests/scene/in_threads.h"

namespace pellucid::test_joint_histogram {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

template <class Value>
std::shared_ptr<const Volume> volume(const std::vector<Value>& values) {
  Volume::Description description;
  description.dimensions = {static_cast<int>(values.size() / 4), 2, 2};
  description.centering = Centering::cell;
  return std::make_shared<const Volume>(description, VolumeData(values));
}

template <class A, class B>
Channels two(const std::vector<A>& a, const std::vector<B>& b) {
  return Channels({{"a", "", volume(a)}, {"b", "", volume(b)}});
}

template <class A>
Channels one(const std::vector<A>& a) {
  return Channels({{"a", "", volume(a)}});
}

TEST(JointHistogram, CountsByHand) {
  const Channels channels =
      two<std::uint8_t, double>({0, 1, 2, 3, 3, 3, 0, 9}, {0, 0.5, 1, 2, 2, 0.9, nan, 1});
  const JointHistogram h = joint_histogram(channels, {0, 1}, {{0, 4, 4}, {0, 2, 2}});
  // Columns are values 0, 1, 2 and 3 to 4, rows 0 to 1 and 1 to 2, the upper end included.
  EXPECT_EQ(h.count, (std::vector<std::uint64_t>{1, 1, 0, 1, 0, 0, 1, 2}));
  EXPECT_EQ(h.nan, 1U);
  EXPECT_EQ(h.outside, 1U);
  const JointHistogram turned = joint_histogram(channels, {1, 0}, {{0, 2, 2}, {0, 4, 4}});
  EXPECT_EQ(turned.count, (std::vector<std::uint64_t>{1, 0, 1, 0, 0, 1, 1, 2}));
}

TEST(JointHistogram, ANumberThatIsMissingCountsOnceWhateverElseIsOutside) {
  const Channels channels =
      two<double, double>({nan, 7, nan, 7, 0, 0, 0, 0}, {7, nan, nan, 7, 0, 0, 0, 0});
  const JointHistogram h = joint_histogram(channels, {0, 1}, {{0, 1, 1}, {0, 1, 1}});
  EXPECT_EQ(h.nan, 3U);
  EXPECT_EQ(h.outside, 1U);
  EXPECT_EQ(h.count, (std::vector<std::uint64_t>{4}));
}

TEST(JointHistogram, HasThreeAxes) {
  std::vector<int> values;
  for (int i = 0; i < 8; ++i) values.push_back(i % 2);
  const JointHistogram h =
      joint_histogram(one(values), {0, 0, 0}, {{-0.5, 1.5, 2}, {-0.5, 1.5, 2}, {-0.5, 1.5, 2}});
  EXPECT_EQ(h.count, (std::vector<std::uint64_t>{4, 0, 0, 0, 0, 0, 0, 4}));
}

TEST(JointHistogram, IsTheSameForAnyNumberOfThreads) {
  std::vector<float> a;
  std::vector<std::int16_t> b;
  unsigned random = 1;
  for (int i = 0; i < 400000; ++i) {
    random = random * 1664525U + 1013904223U;
    a.push_back(static_cast<float>(random >> 8));
    b.push_back(static_cast<std::int16_t>(random >> 20));
  }
  const Channels channels = two(a, b);
  const std::vector<HistogramAxis> axes{histogram_axis(*channels[0].volume, 100),
                                        histogram_axis(*channels[1].volume, 37)};
  const JointHistogram alone = joint_histogram(channels, {0, 1}, axes);
  const JointHistogram together = joint_histogram(channels, {0, 1}, axes, in_threads);
  EXPECT_EQ(alone.count, together.count);
  std::vector<std::uint64_t> expected(alone.count.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto x = static_cast<std::size_t>(axes[0].bin(static_cast<double>(a[i])));
    const auto y = static_cast<std::size_t>(axes[1].bin(b[i]));
    ++expected[x + y * 100];
  }
  EXPECT_EQ(alone.count, expected);
  EXPECT_EQ(alone.outside + alone.nan, 0U);
}

TEST(JointHistogram, RefusesWhatCannotBeCounted) {
  const Channels channels = one<float>({1, 2, 3, 4});
  const HistogramAxis axis{0, 1, 4};
  expect_error([&] { joint_histogram(channels, {}, {}); }, {"0 channels", "from 1 to 3"});
  expect_error(
      [&] {
        joint_histogram(channels, {0, 0, 0, 0}, {axis, axis, axis, axis});
      },
      {"4 channels"});
  expect_error([&] { joint_histogram(channels, {0}, {axis, axis}); }, {"1 channels", "2 axes"});
  expect_error([&] { joint_histogram(channels, {1}, {axis}); }, {"channel 1", "there are 1"});
  expect_error([&] { joint_histogram(channels, {-1}, {axis}); }, {"channel -1"});
  expect_error([&] { joint_histogram(channels, {0}, {{0, 1, 0}}); }, {"bins is 0"});
  expect_error([&] { joint_histogram(channels, {0}, {{1, 1, 4}}); }, {"from 1 to 1", "empty"});
  expect_error([&] { joint_histogram(channels, {0}, {{0, nan, 4}}); }, {"empty"});
  expect_error(
      [&] {
        joint_histogram(channels, {0, 0}, {{0, 1, 1 << 13}, {0, 1, 1 << 12}});
      },
      {"more than 16777216"});
}

TEST(HistogramAxis, BinsOfIntegersHoldEquallyMany) {
  for (const int bins : {1, 2, 7, 100, 255, 256, 300}) {
    std::vector<std::int16_t> values;
    for (int i = 0; i < 1000; ++i) values.push_back(static_cast<std::int16_t>(i - 300));
    const Channels channels = one(values);
    const HistogramAxis axis = histogram_axis(*channels[0].volume, bins);
    ASSERT_LE(axis.bins, bins);
    const JointHistogram h = joint_histogram(channels, {0}, {axis});
    EXPECT_EQ(h.outside, 0U);
    for (std::size_t i = 0; i + 1 < h.count.size(); ++i) {
      EXPECT_EQ(h.count[i], h.count[0]) << bins << " bins, bin " << i;
    }
    EXPECT_GT(h.count.back(), 0U);
    EXPECT_EQ(axis.bin_width(), std::round(axis.bin_width()));
  }
}

TEST(HistogramAxis, GivesEachByteABinOfItsOwn) {
  const HistogramAxis axis = histogram_axis(*volume<std::uint8_t>({0, 255, 3, 4}), 256);
  EXPECT_EQ(axis.bins, 256);
  for (int i = 0; i < 256; ++i) {
    EXPECT_EQ(axis.bin(i), i);
    EXPECT_EQ(axis.center(i), i);
  }
}

TEST(HistogramAxis, EdgesAndBinsAgree) {
  const HistogramAxis axis{-0.7, 3.1, 13};
  EXPECT_EQ(axis.edge(0), axis.lower);
  EXPECT_EQ(axis.edge(13), axis.upper);
  for (int i = 0; i < 13; ++i) {
    EXPECT_EQ(axis.bin(axis.center(i)), i);
    EXPECT_NEAR(axis.edge(i + 1) - axis.edge(i), axis.bin_width(), 1e-15);
    EXPECT_NEAR((axis.edge(i + 1) + axis.edge(i)) / 2, axis.center(i), 1e-15);
  }
  EXPECT_EQ(axis.bin(3.1), 12);
  EXPECT_EQ(axis.bin(std::nextafter(3.1, 4)), -1);
  EXPECT_EQ(axis.bin(-0.8), -1);
  EXPECT_EQ(axis.bin(nan), -1);
}

TEST(HistogramAxis, HoldsEveryVolume) {
  for (const std::vector<double>& values :
       std::vector<std::vector<double>>{{5, 5, 5, 5},
                                        {0, 0, 0, 0},
                                        {-2, -2, nan, -2},
                                        {2e37, 2e37, 2e37, 2e37},
                                        {5e-324, 5e-324, 5e-324, 5e-324},
                                        {0, 5e-324, 0, 0},
                                        {-2e37, 2e37, 0, 1},
                                        {1e9, 1e9 + 1e-6, 1e9, 1e9}}) {
    SCOPED_TRACE(values[0]);
    const Channels channels = one(values);
    const HistogramAxis axis = histogram_axis(*channels[0].volume, 10);
    ASSERT_LT(axis.lower, axis.upper);
    const JointHistogram h = joint_histogram(channels, {0}, {axis});
    EXPECT_EQ(h.outside, 0U);
  }
  const HistogramAxis none = histogram_axis(*volume<double>({nan, nan, nan, nan}), 10);
  EXPECT_EQ(none.lower, 0);
  EXPECT_EQ(none.upper, 1);
  expect_error([] { histogram_axis(*volume<double>({1, 2, 3, 4}), 0); }, {"bins is 0"});
}

}  // namespace
}  // namespace pellucid::test_joint_histogram
