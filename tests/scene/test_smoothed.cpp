// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "derived_fields.h"
#include "expect_error.h"
#include "pellucid/scene/derived_channels.h"

namespace pellucid::test_smoothed {
namespace {

using derived_fields::each;
using derived_fields::in_threads;
using derived_fields::nan;
using derived_fields::of_indices;

Volume::Description description(int nx, int ny, int nz) {
  Volume::Description d;
  d.dimensions = {nx, ny, nz};
  d.centering = Centering::cell;
  d.name = "knee.nrrd";
  return d;
}

double pattern(int i, int j, int k) {
  return (i * 37 + j * 101 + k * 53) % 61 - 20;
}

/// The weighted mean of all values around (i, j, k), as the definition has it: no axis after the
/// other.
double mean_around(const Volume& v, double sigma, int i, int j, int k) {
  const auto& n = v.description().dimensions;
  const Vec3<double>& spacing = v.description().placement.spacing;
  const int index[3] = {i, j, k};
  double sum = 0, share = 0;
  int reach[3];
  for (int a = 0; a < 3; ++a) reach[a] = static_cast<int>(4 * sigma / spacing[a]);
  for (int z = -reach[2]; z <= reach[2]; ++z) {
    for (int y = -reach[1]; y <= reach[1]; ++y) {
      for (int x = -reach[0]; x <= reach[0]; ++x) {
        const int step[3] = {x, y, z};
        double squared = 0;
        std::size_t at[3];
        for (int a = 0; a < 3; ++a) {
          squared += step[a] * spacing[a] * step[a] * spacing[a];
          at[a] = static_cast<std::size_t>(
              std::clamp(index[a] + step[a], 0, n[static_cast<std::size_t>(a)] - 1));
        }
        const double value = std::get<DataArray<double>>(
            v.data())[at[0] + static_cast<std::size_t>(n[0]) *
                                  (at[1] + static_cast<std::size_t>(n[1]) * at[2])];
        if (std::isnan(value)) continue;
        const double w = std::exp(-squared / (2 * sigma * sigma));
        sum += w * value;
        share += w;
      }
    }
  }
  return sum / share;
}

void expect_means(const Volume& v, double sigma) {
  each(smoothed(v, sigma), [&](int i, int j, int k, double s) {
    EXPECT_NEAR(s, mean_around(v, sigma, i, j, k), 4e-6)
        << sigma << " at " << i << " " << j << " " << k;
  });
}

TEST(Smoothed, IsTheWeightedMean) {
  Volume::Description d = description(9, 7, 6);
  d.placement.spacing = {0.5, 1, 0.75};
  const Volume v = of_indices<double>(d, pattern);
  for (const double sigma : {0.05, 0.13, 0.3, 0.8, 1.9}) expect_means(v, sigma);
}

TEST(Smoothed, OnAxesShorterThanTheGaussian) {
  for (const int n : {1, 2, 3}) {
    for (const double sigma : {0.2, 0.25, 0.5, 1.0, 2.5}) {
      expect_means(of_indices<double>(description(n, 1, 4), pattern), sigma);
      expect_means(of_indices<double>(description(4, n, 2), pattern), sigma);
      expect_means(of_indices<double>(description(2, 3, n), pattern), sigma);
    }
  }
}

TEST(Smoothed, NanStaysAndDoesNotCount) {
  const Volume v = of_indices<double>(description(7, 6, 5), [](int i, int j, int k) {
    return (i * 5 + j * 3 + k) % 4 == 0 ? nan : pattern(i, j, k);
  });
  const Volume s = smoothed(v, 0.7);
  EXPECT_EQ(s.statistics().nan, v.statistics().nan);
  each(s, [&](int i, int j, int k, double value) {
    EXPECT_EQ(std::isnan(value), (i * 5 + j * 3 + k) % 4 == 0);
    if (!std::isnan(value)) {
      EXPECT_NEAR(value, mean_around(v, 0.7, i, j, k), 4e-6);
    }
  });
}

TEST(Smoothed, SpreadsByTheVariance) {
  // Axes of other lengths, not at right angles: lengths along them count.
  Volume::Description d = description(41, 41, 41);
  d.placement.spacing = {0.5, 0.25, 0.5};
  d.placement.direction = {{{0.6, 0.8, 0}, {0, 2, 0}, {0, 0.6, 0.8}}};
  const Volume v = of_indices<float>(
      d, [](int i, int j, int k) { return i == 20 && j == 20 && k == 20 ? 1 : 0; });
  double sum = 0, variance[3] = {0, 0, 0};
  each(smoothed(v, 1.5), [&](int i, int j, int k, double s) {
    sum += s;
    variance[0] += s * (i - 20) * (i - 20);
    variance[1] += s * (j - 20) * (j - 20);
    variance[2] += s * (k - 20) * (k - 20);
  });
  EXPECT_NEAR(sum, 1, 1e-6);
  // The cut takes a thousandth of the variance.
  for (const double s2 : variance) EXPECT_NEAR(s2, 9, 0.015);
}

template <class Value>
void expect_constant() {
  const Volume v = of_indices<Value>(description(5, 4, 3), [](int, int, int) { return 101; });
  const Volume s = smoothed(v, 1.5);
  EXPECT_EQ(s.statistics().minimum, 101);
  EXPECT_EQ(s.statistics().maximum, 101);
}

TEST(Smoothed, OfEveryType) {
  expect_constant<std::uint8_t>();
  expect_constant<std::int8_t>();
  expect_constant<std::uint16_t>();
  expect_constant<std::int16_t>();
  expect_constant<std::uint32_t>();
  expect_constant<std::int32_t>();
  expect_constant<float>();
  expect_constant<double>();
}

TEST(Smoothed, KeepsTheLargestValues) {
  const double largest = static_cast<double>(std::numeric_limits<float>::max()) / 16;
  const Volume v =
      of_indices<double>(description(4, 4, 4), [&](int, int, int) { return -largest; });
  EXPECT_EQ(smoothed(v, 1).statistics().minimum, -largest);
}

TEST(Smoothed, TheSameWhateverTheThreads) {
  const Volume v = of_indices<float>(description(9, 8, 21), [](int i, int j, int k) {
    return i == 4 && k == 9 ? nan : pattern(i, j, k);
  });
  const Volume once = smoothed(v, 1.1);
  const auto& expected = std::get<DataArray<float>>(once.data());
  EXPECT_EQ(once.description().name, "knee.nrrd smoothed by 1.1");
  for (const int parts : {1, 2, 5, 32}) {
    const Volume s = smoothed(v, 1.1, in_threads(parts));
    const auto& values = std::get<DataArray<float>>(s.data());
    EXPECT_EQ(std::memcmp(values.data(), expected.data(), expected.size() * sizeof(float)), 0)
        << parts;
  }
}

TEST(Smoothed, WhatItCannotDo) {
  const Volume v = of_indices<float>(description(3, 3, 3), pattern);
  for (const double sigma : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
    expect_error([&] { smoothed(v, sigma); }, {"knee.nrrd: ", "smoothed", "sigma", "positive"});
  }
  expect_error([&] { smoothed(v, 1e6); }, {"knee.nrrd: ", "1e+06 times", "at most 16384"});
  Volume::Description d = description(2, 2, 2);
  d.coordinates[1] = {0, 1, 3};
  expect_error([&] { smoothed(of_indices<float>(d, pattern), 1); },
               {"knee.nrrd: ", "rectilinear along y", "resample"});
}

}  // namespace
}  // namespace pellucid::test_smoothed
