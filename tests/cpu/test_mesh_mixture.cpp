// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "pellucid/scene/multivariate_transfer_function.h"
#include "pellucid/segment/gaussian_linear.h"
#include "src/cpu/mesh_mixture_storage.h"
#include "tests/scene/lattice_mesh.h"
#include "tests/segment/line_exponent.h"

namespace pellucid {
namespace {

/// One tetrahedron's points with these values in all channels.
MeshChannels channels_of(int count, double lower, double upper) {
  const auto mesh = std::make_shared<const TetrahedralMesh>(lattice_mesh(1, 1));
  std::vector<MeshChannel> all;
  for (int c = 0; c < count; ++c) {
    std::vector<double> values(mesh->points().size(), lower);
    values.back() = upper;
    all.push_back({std::to_string(c), "", Centering::point, values});
  }
  return {mesh, std::move(all)};
}

/// What binary32 takes for far has no more extinction than it may, of data in double, also far from
/// 0; and it takes most of what is far for that.
TEST(MeshMixture, FarIsFar) {
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
    const Multivariate<double> transfer = function.view();
    const double opacity = power(1e-7, 1e-3), diagonal = power(0.1, 100);
    MeshMixtureStorage storage(channels_of(count, offset, offset + 1), transfer, opacity, diagonal);
    const MeshMixture& mixture = storage.view();
    ASSERT_DOUBLE_EQ(mixture.left_out * diagonal, opacity);
    for (int span = 0; span < 50; ++span) {
      double front[most_channels], back[most_channels];
      LinearBernstein<float> data[most_channels];
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

/// Extinction changes by no more than steepness times what the data do.
TEST(MeshMixture, SteepnessBoundsChanges) {
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
    MeshMixtureStorage storage(channels_of(count, -1, 1), function.view(), 1e-3, 1);
    const MeshMixture& mixture = storage.view();
    ASSERT_TRUE(storage.suits_packets());
    for (int n = 0; n < 200; ++n) {
      double a[most_channels], b[most_channels], bound = 0;
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

TEST(MeshMixture, WhatBinary32HasNotIsNotForPackets) {
  GaussianPrimitive p;
  p.channels = {0};
  p.center = {0};
  p.matrix = {{1e36}};
  p.extinction = 1;
  const MultivariateTransferFunction function(1, {p});
  MeshMixtureStorage storage(channels_of(1, 0, 1e-35), function.view(), 1e-3, 1);
  EXPECT_FALSE(storage.suits_packets());
  EXPECT_TRUE(std::isnan(storage.view().primitive[0].square));
}

}  // namespace
}  // namespace pellucid
