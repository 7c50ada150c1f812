// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "pellucid/scene/multivariate_transfer_function.h"
#include "pellucid/segment/gaussian_linear.h"
#include "src/cpu/gaussians/culled_mixture_storage.h"
#include "tests/segment/line_exponent.h"

namespace pellucid::test_near_mixture {
namespace {

/// What binary32 takes for far has no more extinction than it may, of data in double, also far from
/// 0; and it takes most of what is far for that.
TEST(CulledMixture, FarIsFar) {
  std::mt19937_64 random(3);
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  const auto power = [&](double a, double b) { return a * std::pow(b / a, uniform(0, 1)); };
  long far = 0, found = 0, near = 0;
  for (int scene = 0; scene < 200; ++scene) {
    const int count = 1 + static_cast<int>(random() % 8);
    const double offset = random() % 2 == 0 ? 0 : power(1, 1e4), width = power(1e-3, 10);
    std::vector<GaussianPrimitive> primitives;
    for (int i = 0; i < 4; ++i) {
      GaussianPrimitive p;
      for (int c = 0; c < count; ++c) {
        p.channels.push_back(c);
        p.center.push_back(offset + uniform(0, 1));
      }
      p.matrix.assign(1 + random() % p.channels.size(), {});
      for (auto& row : p.matrix) {
        for (int c = 0; c < count; ++c) row.push_back(uniform(-1, 1) / width);
      }
      p.extinction = power(1e-9, 1e4);
      primitives.push_back(p);
    }
    const MultivariateTransferFunction function(count, primitives);
    const MultivariateTransfer<double> transfer = function.view();
    const double opacity = power(1e-7, 1e-3), diagonal = power(0.1, 100);
    const std::vector<double> largest(max_channels, offset + 1);
    NearMixtureStorage storage(largest.data(), true, transfer, opacity, diagonal);
    const CulledMixture& mixture = storage.view();
    ASSERT_DOUBLE_EQ(mixture.left_out * diagonal, opacity);
    for (int span = 0; span < 50; ++span) {
      double front[max_channels], back[max_channels];
      LinearBernstein<float> data[max_channels];
      const double size = power(1e-3, 1);
      for (int c = 0; c < count; ++c) {
        front[c] = offset + uniform(0, 1);
        back[c] = std::clamp(front[c] + size * uniform(-1, 1), offset, offset + 1);
        data[c] = {{static_cast<float>(front[c]), static_cast<float>(back[c])}};
      }
      const double less = random() % 2 == 0 ? 0 : uniform(0, 12);
      for (int i = 0; i < transfer.gaussians.count; ++i) {
        const Gaussian<double>& g = transfer.gaussians.primitive[i];
        const NearGaussian& one = mixture.primitive[i];
        const long double extinction =
            static_cast<long double>(g.peak) *
            std::exp(-test::LineExponent<double>{g, front, back}.least());
        const long double negligible =
            static_cast<long double>(mixture.left_out / transfer.gaussians.count * std::exp(less));
        const bool comes = GaussianLinear<float>(one.gaussian, data)
                               .comes_within(one.square - static_cast<float>(less));
        if (!comes) {
          ASSERT_LE(extinction, negligible * (1 + 1e-5L)) << scene;
          ++found;
        }
        ++(extinction > negligible ? near : far);
      }
    }
  }
  EXPECT_GT(near, 2000);
  EXPECT_GT(found, far / 2);
}

/// The least |K (v - c)|² in a box: of a convex function, along one axis after the other, from
/// above: of rows that are nearly alike it may be short of the least.
double least_in_box(const Gaussian<double>& g, const double* lower, const double* upper,
                    int sweeps) {
  double v[max_channels], p[max_channels];
  for (int c = 0; c < g.channels; ++c) v[c] = std::clamp(g.center[c], lower[c], upper[c]);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (int c = 0; c < g.channels; ++c) {
      double slope = 0, bend = 0;
      g.transform(v, p);
      for (int i = 0; i < g.rows; ++i) {
        slope += p[i] * g.matrix[i][c];
        bend += g.matrix[i][c] * g.matrix[i][c];
      }
      if (bend > 0) v[c] = std::clamp(v[c] - slope / bend, lower[c], upper[c]);
    }
  }
  double square = 0;
  g.transform(v, p);
  for (int i = 0; i < g.rows; ++i) square += p[i] * p[i];
  return square;
}

/// A primitive through any of the channels, of any rank, whose rows look at one channel each or at
/// several; far from 0 in one of four cases.
struct BoxCase {
  int channels;
  bool couples;
  double offset;
  GaussianPrimitive primitive;

  template <class Random>
  explicit BoxCase(Random& random) {
    const auto uniform = [&](double a, double b) {
      return std::uniform_real_distribution<double>(a, b)(random);
    };
    channels = 1 + static_cast<int>(random() % max_channels);
    const auto count = static_cast<std::size_t>(channels);
    couples = channels > 1 && random() % 2 == 0;
    offset = random() % 4 == 0 ? std::pow(10.0, uniform(0, 3)) : 0;
    const double width = std::pow(10.0, uniform(-2, 0));
    for (int c = 0; c < channels; ++c) {
      primitive.channels.push_back(c);
      primitive.center.push_back(offset + uniform(0, 1));
    }
    primitive.matrix.assign(1 + random() % count, std::vector<double>(count));
    for (auto& row : primitive.matrix) {
      const std::size_t one = random() % count;
      for (std::size_t c = 0; c < count; ++c) {
        if (couples || c == one) row[c] = uniform(-1, 1) / width;
      }
    }
  }
};

/// Boxes of values in which a primitive is far in binary32 have no more extinction of it than they
/// may, by a hair where it is there to see; where no row looks at two channels this is all that are
/// far, elsewhere most of them.
TEST(CulledMixture, FarFromABoxIsFar) {
  std::mt19937_64 random(11);
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  const auto power = [&](double a, double b) { return a * std::pow(b / a, uniform(0, 1)); };
  long far[2] = {}, found[2] = {}, by_a_channel = 0;
  for (int n = 0; n < 40000; ++n) {
    BoxCase at(random);
    double lower[max_channels], upper[max_channels];
    float least[max_channels], most[max_channels];
    for (int c = 0; c < at.channels; ++c) {
      lower[c] = at.offset + uniform(0, 1);
      upper[c] = std::min(lower[c] + power(1e-3, 1), at.offset + 1);
      least[c] = static_cast<float>(lower[c]);
      most[c] = static_cast<float>(upper[c]);
    }
    const double opacity = power(1e-6, 1e-3), less = random() % 2 == 0 ? 0 : uniform(0, 12);
    at.primitive.extinction = 1;
    const MultivariateTransferFunction unit(at.channels, {at.primitive});
    const double exponent = least_in_box(unit.view().gaussians.primitive[0], lower, upper, 400);
    // Half of them a hair nearer than they may be for it.
    const bool is_close = random() % 2 == 0 && exponent < 60;
    at.primitive.extinction =
        is_close ? opacity * std::exp(exponent + less) * (1 + power(2e-5, 1)) : power(1e-3, 1e3);
    const MultivariateTransferFunction function(at.channels, {at.primitive});
    const std::vector<double> largest(max_channels, at.offset + 1);
    NearMixtureStorage storage(largest.data(), true, function.view(), opacity, 1);
    const NearGaussian& near = storage.view().primitive[0];
    ASSERT_TRUE(at.couples || !near.couples_channels);
    const double extinction = at.primitive.extinction * std::exp(-exponent),
                 may_be = opacity * std::exp(less);
    const float square = near.square - static_cast<float>(less);
    const bool is_found = least_exponent_by_rows(near, least, most) >= square;
    if (is_found) {
      ASSERT_LE(extinction, may_be * (1 + 1e-5)) << n;
    }
    if (extinction > 0.99 * may_be || at.offset > 0) continue;
    ++far[near.couples_channels ? 1 : 0];
    found[near.couples_channels ? 1 : 0] += is_found ? 1 : 0;
    NearGaussian rows_alone = near;
    rows_alone.couples_channels = false;
    by_a_channel += is_found && !(least_exponent_by_rows(rows_alone, least, most) >= square);
  }
  std::printf(
      "[ accuracy ] of %ld boxes that are far for rows that couple channels %ld are known, "
      "%ld by a channel alone\n",
      far[1], found[1], by_a_channel);
  EXPECT_GT(far[0], 2000);
  EXPECT_EQ(found[0], far[0]);
  EXPECT_GT(far[1], 2000);
  EXPECT_GT(static_cast<double>(found[1]), 0.95 * static_cast<double>(far[1]));
  EXPECT_GT(by_a_channel, 5);
}

/// Extinction changes by no more than steepness times what the data do.
TEST(CulledMixture, SteepnessBoundsChanges) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  double largest = 0;
  for (int scene = 0; scene < 300; ++scene) {
    const int count = 1 + scene % 4;
    std::vector<GaussianPrimitive> primitives;
    for (int i = 0; i < 3; ++i) {
      GaussianPrimitive p;
      for (int c = 0; c < count; ++c) {
        p.channels.push_back(c);
        p.center.push_back(0.2 * normal(random));
      }
      p.matrix.assign(static_cast<std::size_t>(1 + scene % count), {});
      for (auto& row : p.matrix) {
        for (int c = 0; c < count; ++c) row.push_back(3 * normal(random));
      }
      p.extinction = std::exp(normal(random));
      primitives.push_back(p);
    }
    const MultivariateTransferFunction function(count, primitives);
    const std::vector<double> values(max_channels, 1.0);
    NearMixtureStorage storage(values.data(), true, function.view(), 1e-3, 1);
    const CulledMixture& mixture = storage.view();
    ASSERT_TRUE(storage.suits_packets());
    for (int n = 0; n < 200; ++n) {
      double a[max_channels], b[max_channels], bound = 0;
      for (int c = 0; c < count; ++c) {
        a[c] = 0.3 * normal(random);
        b[c] = a[c] + 1e-4 * normal(random);
        bound += mixture.steepness[c] * std::fabs(b[c] - a[c]);
      }
      const double change = std::fabs(mixture.transfer.evaluate(a).extinction -
                                      mixture.transfer.evaluate(b).extinction);
      ASSERT_LE(change, bound * (1 + 1e-9));
      largest = std::max(largest, change / bound);
    }
  }
  EXPECT_GT(largest, 0.9);
}

/// |K (v - c)| is at least least_scale times the distance in a channel, and that is where the other
/// channels make it least.
TEST(CulledMixture, LeastScaleIsReached) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  int reached = 0, without = 0;
  for (int n = 0; n < 400; ++n) {
    const int channels = 1 + n % 5,
              rows = 1 + static_cast<int>(random() % static_cast<unsigned>(channels));
    GaussianPrimitive p;
    for (int c = 0; c < channels; ++c) {
      p.channels.push_back(c);
      p.center.push_back(0);
    }
    p.matrix.assign(static_cast<std::size_t>(rows), {});
    for (auto& row : p.matrix) {
      for (int c = 0; c < channels; ++c) row.push_back(normal(random));
    }
    // A channel that it does not look at, and one that another can make up for.
    if (n % 7 == 0) {
      for (auto& row : p.matrix) row.front() = 0;
    }
    if (n % 11 == 0 && channels > 1) {
      for (auto& row : p.matrix) row.back() = 3 * row.front();
    }
    p.extinction = 1;
    const MultivariateTransferFunction function(channels, {p});
    const std::vector<double> values(max_channels, 1.0);
    NearMixtureStorage storage(values.data(), false, function.view(), 1e-3, 1);
    const NearGaussian& near = storage.view().primitive[0];
    const Gaussian<double>& g = function.view().gaussians.primitive[0];
    for (int c = 0; c < channels; ++c) {
      double lower[max_channels], upper[max_channels];
      std::fill(lower, lower + channels, -std::numeric_limits<double>::infinity());
      std::fill(upper, upper + channels, std::numeric_limits<double>::infinity());
      lower[c] = upper[c] = 1;
      const double least = std::sqrt(least_in_box(g, lower, upper, 3000)),
                   scale = static_cast<double>(near.least_scale[c]);
      ASSERT_LE(scale, least + 1e-15) << n << ' ' << c;
      if (scale > 0.05 && least < scale * 1.001) ++reached;
      if (scale == 0) ++without;
    }
  }
  EXPECT_GT(reached, 300);
  EXPECT_GT(without, 100);
}

TEST(CulledMixture, WhatBinary32HasNotIsNotForPackets) {
  GaussianPrimitive p;
  p.channels = {0};
  p.center = {0};
  p.matrix = {{1e36}};
  p.extinction = 1;
  const MultivariateTransferFunction function(1, {p});
  const double largest = 1e-35;
  NearMixtureStorage storage(&largest, true, function.view(), 1e-3, 1);
  EXPECT_FALSE(storage.suits_packets());
  EXPECT_TRUE(std::isnan(storage.view().primitive[0].square));
}

}  // namespace
}  // namespace pellucid::test_near_mixture
