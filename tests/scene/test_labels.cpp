// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/labels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <set>
#include <variant>
#include <vector>

#include "pellucid/scene/internal/label_values.h"

namespace pellucid::test_labels {
namespace {

constexpr int side = 48;

/// Whole numbers that look random, the same each time.
class Noise {
 public:
  unsigned next(unsigned count) {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<unsigned>(state_ >> 33) % count;
  }

 private:
  std::uint64_t state_ = 7;
};

template <class Value>
Volume volume(const std::function<double(int, int, int)>& f, int n = side) {
  Volume::Description description;
  description.dimensions = {n, n, n};
  std::vector<Value> values;
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) values.push_back(static_cast<Value>(f(i, j, k)));
    }
  }
  return Volume(description, VolumeData(values));
}

double radius(int i, int j, int k) {
  return std::hypot(i - 23.5, j - 23.5, k - 23.5);
}

/// The nearest of so many seeds, each with a number of its own; outside of a ball 0.
std::function<double(int, int, int)> regions(int count, int step) {
  Noise noise;
  std::vector<std::array<int, 3>> seeds;
  for (int s = 0; s < count; ++s) {
    std::array<int, 3> seed{};
    for (int& x : seed) x = static_cast<int>(noise.next(side));
    seeds.push_back(seed);
  }
  return [seeds, step](int i, int j, int k) {
    if (radius(i, j, k) > 22) return 0.0;
    const auto distance = [&](const std::array<int, 3>& s) {
      return std::hypot(s[0] - i, s[1] - j, s[2] - k);
    };
    const auto nearest = std::ranges::min_element(seeds, {}, distance);
    return 1.0 + step * static_cast<double>(nearest - seeds.begin());
  };
}

/// Not every seed needs to have a voxel.
std::size_t different_values(const Volume& v) {
  std::set<double> values;
  std::visit(
      [&](const auto& data) {
        for (const auto value : data) {
          const auto x = static_cast<double>(value);
          if (!std::isnan(x)) values.insert(x);
        }
      },
      v.data());
  return values.size();
}

void expect_labels(const Volume& v, std::size_t least) {
  EXPECT_EQ(label_count(v), different_values(v));
  EXPECT_GE(different_values(v), least);
}

TEST(Labels, SegmentationsLookLikeLabels) {
  expect_labels(volume<std::uint8_t>(regions(25, 1)), 20);
  expect_labels(volume<std::uint16_t>(regions(25, 47)), 20);
  expect_labels(volume<float>(regions(25, 1000)), 20);
  expect_labels(volume<std::int32_t>(regions(60, 20000000)), 40);
  expect_labels(volume<double>(regions(3, 1)), 4);
  // Air around, marked by NaN.
  const auto inner = regions(12, 1);
  expect_labels(volume<float>([&](int i, int j, int k) {
                  return radius(i, j, k) > 22 ? std::numeric_limits<double>::quiet_NaN()
                                              : inner(i, j, k);
                }),
                9);
}

TEST(Labels, PartsTellTheirValues) {
  const auto part = volume<float>([](int i, int, int) { return i < 20 ? -1 : 3; });
  EXPECT_EQ(label_values_of_part(part), (std::vector<double>{-1, 3}));
  // One value says nothing of the whole, but is there.
  EXPECT_EQ(label_values_of_part(volume<std::uint8_t>([](int, int, int) { return 7; })),
            std::vector<double>{7});
  EXPECT_FALSE(label_count(volume<std::uint8_t>([](int, int, int) { return 7; })));
  Noise noise;
  EXPECT_FALSE(
      label_values_of_part(volume<std::uint8_t>([&](int, int, int) { return noise.next(256); })));
}

TEST(Labels, MasksLookLikeLabels) {
  EXPECT_EQ(label_count(volume<std::uint8_t>(
                [](int i, int j, int k) { return radius(i, j, k) < 15 ? 1 : 0; })),
            2U);
  // Thin lines, and values of 0 and 255.
  EXPECT_EQ(label_count(volume<std::uint8_t>(
                [](int i, int j, int) { return i % 16 == 0 && j % 16 == 0 ? 255 : 0; })),
            2U);
  EXPECT_EQ(label_count(volume<float>([](int i, int, int) { return i < 20 ? -1 : 1; })), 2U);
}

TEST(Labels, MeasuredAndSmoothDataDoNot) {
  Noise noise;
  const auto smooth = [](int i, int j, int k) { return 200 * std::exp(-radius(i, j, k) / 12); };
  EXPECT_FALSE(label_count(volume<std::uint8_t>(smooth)));
  // Few grey levels, each in a thick shell.
  EXPECT_FALSE(label_count(
      volume<std::uint8_t>([](int i, int j, int k) { return std::floor(radius(i, j, k) / 3); })));
  EXPECT_FALSE(label_count(volume<std::uint8_t>([&](int, int, int) { return noise.next(256); })));
  EXPECT_FALSE(label_count(volume<std::uint8_t>([&](int, int, int) { return noise.next(4); })));
  EXPECT_FALSE(label_count(volume<std::uint8_t>([&](int, int, int) { return noise.next(2); })));
  // Tissues with noise, in air that was set to 0.
  EXPECT_FALSE(label_count(volume<std::uint8_t>([&](int i, int j, int k) {
    const double r = radius(i, j, k);
    return r > 18 ? 0 : (r > 10 ? 80 : 140) + noise.next(12);
  })));
  // A ball without noise whose edge is blurred.
  EXPECT_FALSE(label_count(volume<std::uint8_t>([](int i, int j, int k) {
    return std::round(255 * std::clamp((16 - radius(i, j, k)) / 3 + 0.5, 0.0, 1.0));
  })));
  // Counts of rare events.
  EXPECT_FALSE(label_count(volume<std::uint8_t>([&](int i, int, int) {
    return noise.next(100) < (i > 24 ? 30U : 3U) ? 1 + noise.next(5) : 0;
  })));
  EXPECT_FALSE(label_count(
      volume<float>([&](int i, int j, int k) { return regions(1, 1)(i, j, k) / 4; }, 8)));
}

TEST(Labels, OneValueAndManyAreNone) {
  EXPECT_FALSE(label_count(volume<std::uint8_t>([](int, int, int) { return 7; })));
  EXPECT_FALSE(label_count(
      volume<float>([](int, int, int) { return std::numeric_limits<double>::quiet_NaN(); })));
  // 13 824 regions of 2³ voxels.
  EXPECT_FALSE(label_count(volume<std::uint16_t>(
      [](int i, int j, int k) { return (i / 2) + 24 * (j / 2) + 576 * (k / 2); })));
}

TEST(Labels, RareOnesOfALargeVolumeAreCounted) {
  constexpr int large = 160;
  const Volume v = volume<std::uint8_t>(
      [](int i, int j, int k) {
        if (i == 3 && j == 77 && k == 101) return 200;
        return i / 20 % 2 == 0 ? 9 * (j / 40) + 50 * (k / 80) : 0;
      },
      large);
  EXPECT_EQ(label_count(v), 9U);
}

}  // namespace
}  // namespace pellucid::test_labels
