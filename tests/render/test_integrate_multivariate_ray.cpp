// SPDX-License-Identifier: Apache-2.0
#include "pellucid/render/integrate_multivariate_ray.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "tests/render/test_grid.h"
#include "tests/segment/multivariate_case.h"
#include "tests/support/accuracy.h"
#include "tests/support/wide_functions.h"
#include "tests/traverse/block_field.h"

namespace pellucid::test_integrate_multivariate_ray {
namespace {

using test::ErrorRecord;
using test::Maker;
using test::WideStretch;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Channels of doubles on one point-centred grid.
struct TestChannels {
  int n[3];
  std::vector<std::vector<double>> data;
  TestChannels(int nx, int ny, int nz, int channels) : n{nx, ny, nz} {
    data.assign(static_cast<std::size_t>(channels),
                std::vector<double>(static_cast<std::size_t>(nx * ny * nz)));
  }
  double& at(int c, int i, int j, int k) {
    return data[static_cast<std::size_t>(c)][static_cast<std::size_t>(i + n[0] * (j + n[1] * k))];
  }
  double at(int c, int i, int j, int k) const {
    return data[static_cast<std::size_t>(c)][static_cast<std::size_t>(i + n[0] * (j + n[1] * k))];
  }
  template <class F>
  void fill(const F& f) {
    for (int c = 0; c < static_cast<int>(data.size()); ++c) {
      for (int k = 0; k < n[2]; ++k) {
        for (int j = 0; j < n[1]; ++j) {
          for (int i = 0; i < n[0]; ++i) at(c, i, j, k) = f(c, i, j, k);
        }
      }
    }
  }
  MultichannelGrid view() const {
    MultichannelGrid grid;
    grid.channels = static_cast<int>(data.size());
    for (int c = 0; c < grid.channels; ++c) {
      grid.data[c] = data[static_cast<std::size_t>(c)].data();
      grid.type[c] = ValueType::f64;
    }
    for (int a = 0; a < 3; ++a) grid.axis[a] = {nullptr, n[a], 0};
    return grid;
  }
};

/// A transfer function of its own.
struct TestTransfer {
  std::vector<Gaussian<double>> gaussians;
  TestTable<double> table;
  std::vector<ChannelTable<double>> tables;
  int channels = 1;
  TestTransfer(Maker& maker, int channels_here, int gaussians_here, bool with_table)
      : channels(channels_here) {
    for (int i = 0; i < gaussians_here; ++i) {
      Gaussian<double> g;
      g.channels = g.rows = channels;
      for (int r = 0; r < channels; ++r) {
        for (int c = 0; c < channels; ++c) g.matrix[r][c] = 3 * maker.normal() / channels;
        g.matrix[r][r] += maker.powers(1, 8);
        g.center[r] = maker.uniform(0, 1);
      }
      g.peak = maker.powers(0.05, 2);
      g.color = {maker.uniform(0, 1), i % 2 == 0 ? 1.0 : 0.0, maker.uniform(0, 1)};
      gaussians.push_back(g);
    }
    if (with_table) tables.push_back({maker.pick(channels), table.view()});
  }
  MultivariateTransfer<double> view() const {
    MultivariateTransfer<double> result;
    result.gaussians = {gaussians.data(), static_cast<int>(gaussians.size())};
    result.table = tables.data();
    result.tables = static_cast<int>(tables.size());
    result.channels = channels;
    return result;
  }
  double largest_extinction() const {
    double sum = tables.empty() ? 0 : 4;
    for (const Gaussian<double>& g : gaussians) sum += g.peak;
    return sum;
  }
};

RayResult integrate(const TestChannels& channels, const Ray<double>& ray,
                    const TestTransfer& transfer, double tolerance, Grade grade = Grade::estimated,
                    bool with_depth = false, const MultivariateBlocks* blocks = nullptr) {
  return integrate_multivariate_ray(channels.view(), blocks, ray, transfer.view(),
                                    transfer.largest_extinction(),
                                    {tolerance, grade, Precision::automatic, 1}, with_depth);
}

/// The ray as far as `end`, by brute force: cut at the planes of the grid in long double, the
/// trilinear data of each part from the eight corners at four places. Vacuum where a corner is NaN.
WideStretch wide_ray(const TestChannels& channels, const Ray<double>& ray,
                     const TestTransfer& transfer, long double end = 1e30L) {
  using Number = long double;
  Number begin = 0;
  std::vector<Number> cuts;
  for (int a = 0; a < 3; ++a) {
    const Number o = static_cast<Number>(ray.origin[a]), d = static_cast<Number>(ray.direction[a]);
    if (d == 0) {
      if (o < 0 || o > channels.n[a] - 1) return {};
      continue;
    }
    Number first = -o / d, last = (channels.n[a] - 1 - o) / d;
    if (first > last) std::swap(first, last);
    begin = std::max(begin, first);
    end = std::min(end, last);
    for (int p = 0; p < channels.n[a]; ++p) cuts.push_back((p - o) / d);
  }
  if (!(begin < end)) return {};
  cuts.push_back(begin);
  cuts.push_back(end);
  std::sort(cuts.begin(), cuts.end());
  const MultivariateTransfer<double> view = transfer.view();
  WideStretch sum;
  for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
    const Number t0 = cuts[k], t1 = cuts[k + 1];
    if (t0 < begin || t1 > end || !(t1 - t0 > 1e-15L)) continue;
    int cell[3];
    for (int a = 0; a < 3; ++a) {
      const Number middle = static_cast<Number>(ray.origin[a]) +
                            (t0 + t1) / 2 * static_cast<Number>(ray.direction[a]);
      cell[a] = std::clamp(static_cast<int>(std::floor(middle)), 0, channels.n[a] - 2);
    }
    MultivariateSpan<double> span;
    span.length = static_cast<double>(t1 - t0);
    bool vacuum = false;
    for (int c = 0; c < transfer.channels; ++c) {
      Number f[4];
      for (int i = 0; i < 4; ++i) {
        const Number t = t0 + (t1 - t0) * i / 3;
        f[i] = 0;
        for (int corner = 0; corner < 8; ++corner) {
          Number weight = 1;
          int p[3];
          for (int a = 0; a < 3; ++a) {
            const Number x = static_cast<Number>(ray.origin[a]) +
                             t * static_cast<Number>(ray.direction[a]) - cell[a];
            const int up = (corner >> a) & 1;
            p[a] = cell[a] + up;
            weight *= up != 0 ? x : 1 - x;
          }
          f[i] += weight * static_cast<Number>(channels.at(c, p[0], p[1], p[2]));
        }
        vacuum = vacuum || std::isnan(f[i]);
      }
      span.data[c] = {{static_cast<double>(f[0]),
                       static_cast<double>((-5 * f[0] + 18 * f[1] - 9 * f[2] + 2 * f[3]) / 6),
                       static_cast<double>((2 * f[0] - 9 * f[1] + 18 * f[2] - 5 * f[3]) / 6),
                       static_cast<double>(f[3])}};
    }
    if (!vacuum) sum.add(test::wide_multivariate(view, span));
  }
  return sum;
}

long double ray_error(const RayResult& found, const WideStretch& truth) {
  SegmentResult<double> segment;
  segment.radiance = found.radiance;
  segment.opacity = found.opacity;
  return test::pixel_error(segment, truth, 1);
}

TestChannels noise(Maker& maker, int points, int channels) {
  TestChannels result(points, points, points, channels);
  const double rough = maker.powers(0.02, 0.5);
  result.fill([&](int c, int i, int j, int k) {
    const double wave = c % 2 == 0 ? i + 0.5 * j : k - 0.3 * i;
    return 0.5 + 0.3 * std::sin(0.7 * wave + c) + rough * maker.uniform(-1, 1);
  });
  return result;
}

/// Through the grid from outside, from inside or along an axis.
Ray<double> random_ray(Maker& maker, int points) {
  const double side = points - 1;
  Vec3<double> p{maker.uniform(0, side), maker.uniform(0, side), maker.uniform(0, side)};
  Vec3<double> d{maker.normal(), maker.normal(), maker.normal()};
  const int kind = maker.pick(4);
  if (kind == 0) {
    const int axis = maker.pick(3);
    d = {0, 0, 0};
    d[axis] = maker.pick(2) == 0 ? 1 : -1;
  }
  d = normalized(d);
  return {kind == 1 ? p : p - d * (3.0 * points), d};
}

TEST(IntegrateMultivariateRay, RandomRaysAreWithinTheirErrors) {
  for (const Grade grade : {Grade::estimated, Grade::proved}) {
    Maker maker(grade == Grade::proved ? 110 : 111);
    for (const double tolerance : {1e-1, 1e-2, 1e-3, 1e-5, 1e-7, 1e-9}) {
      if (grade == Grade::proved && tolerance < 1e-7) continue;
      ErrorRecord share("ray, error / reported, " + std::to_string(std::log10(tolerance)), "");
      long counted = 0, nodes = 0;
      for (int i = 0; i < 60; ++i) {
        const int points = 5, count = 1 + maker.pick(3);
        const TestChannels channels = noise(maker, points, count);
        const TestTransfer transfer(maker, count, 1 + maker.pick(4), i % 3 == 0);
        const Ray<double> ray = random_ray(maker, points);
        const RayResult found = integrate(channels, ray, transfer, tolerance, grade);
        const WideStretch truth = wide_ray(channels, ray, transfer);
        const std::string where = "ray " + std::to_string(i);
        share.add(ray_error(found, truth) / (static_cast<long double>(found.error) + 1e-13L),
                  where);
        // Below what may be asked for, rounding takes a part of its own.
        EXPECT_LE(found.error, tolerance * (tolerance < 1e-7 ? 1.1 : 1)) << where;
        EXPECT_TRUE(found.proved || grade == Grade::estimated) << where;
        EXPECT_NEAR(found.opacity, -std::expm1(-found.optical_depth), 1e-12) << where;
        counted += truth.opacity() > 0.01L;
        nodes += static_cast<long>(found.spans.panels);
      }
      share.print();
      EXPECT_LE(share.largest(), 1) << tolerance;
      EXPECT_GT(counted, 30);
      if (grade == Grade::proved) {
        EXPECT_EQ(nodes, 0);
      }
    }
  }
}

/// Data that rise from 0 to 1 along x, in two channels at different speed: erf at 50 digits.
TEST(IntegrateMultivariateRay, LinearRampsAgainstTheErrorFunction) {
  using test::Wide;
  Maker maker(112);
  ErrorRecord share("ramp, error / reported", "");
  for (int i = 0; i < 300; ++i) {
    const int points = 3 + maker.pick(30);
    TestChannels channels(points, 2, 2, 2);
    const double slope[2] = {1.0 / 32, maker.pick(2) == 0 ? -0.5 : 0.25};
    channels.fill([&](int c, int x, int, int) { return slope[c] * x; });
    TestTransfer transfer(maker, 2, 1, false);
    Gaussian<double>& g = transfer.gaussians[0];
    g.rows = 2;
    const double k0 = maker.powers(0.3, 30), k1 = maker.powers(0.03, 3);
    g.matrix[0][0] = k0;
    g.matrix[1][1] = k1;
    g.matrix[0][1] = g.matrix[1][0] = 0;
    g.center[1] = 0.5 * maker.normal();
    const double tolerance = maker.powers(1e-9, 1e-1);
    // Both Gaussians together: |a + b x|² along x.
    const Wide b0 = Wide(k0) * slope[0], b1 = Wide(k1) * slope[1], a0 = -Wide(k0) * g.center[0],
               a1 = -Wide(k1) * g.center[1];
    const Wide bb = b0 * b0 + b1 * b1, middle = -(a0 * b0 + a1 * b1) / bb, b = sqrt(bb);
    const Wide apart = pow(a0 * b1 - a1 * b0, 2) / bb;
    const Wide depth = Wide(g.peak) * exp(-apart) * test::wide_sqrt_pi() / (2 * b) *
                       (test::wide_erf(b * (points - 1 - middle)) + test::wide_erf(b * middle));
    const auto opacity = static_cast<long double>(depth * test::wide_expm1_quotient(depth));
    const Ray<double> forward{{-2, 0.25, 0.75}, {1, 0, 0}};
    const RayResult found = integrate(channels, forward, transfer, tolerance, Grade::proved);
    const std::string where = "ramp " + std::to_string(i);
    share.add(std::fabs(static_cast<long double>(found.opacity) - opacity) /
                  (static_cast<long double>(found.error) + 1e-14L),
              where);
    EXPECT_LE(found.error, tolerance) << where;
    EXPECT_NEAR(found.radiance.r, g.color.r * found.opacity, 1e-15) << where;
    // One color along a line: nothing to cut.
    EXPECT_EQ(found.spans.panels, 0u);
    EXPECT_LE(found.spans.lines + found.spans.skipped, static_cast<std::uint64_t>(points - 1));
    const RayResult backward = integrate(channels, {{points + 3.0, 0.25, 0.75}, {-1, 0, 0}},
                                         transfer, tolerance, Grade::proved);
    EXPECT_NEAR(found.opacity, backward.opacity, found.error + backward.error + 1e-14) << where;
  }
  share.print();
  EXPECT_LE(share.largest(), 1);
}

TEST(IntegrateMultivariateRay, HalfOpacityDepthHalvesTheOpacity) {
  Maker maker(113);
  int found = 0;
  for (int i = 0; i < 60; ++i) {
    const int count = 1 + maker.pick(2);
    const TestChannels channels = noise(maker, 5, count);
    const TestTransfer transfer(maker, count, 2, i % 2 == 0);
    const Ray<double> ray = random_ray(maker, 5);
    const RayResult r = integrate(channels, ray, transfer, 1e-6, Grade::estimated, true);
    if (!(r.opacity > 1e-3)) {
      EXPECT_EQ(r.opacity > 0, std::isfinite(r.half_opacity_depth));
      continue;
    }
    ++found;
    const WideStretch half =
        wide_ray(channels, ray, transfer, static_cast<long double>(r.half_opacity_depth));
    EXPECT_NEAR(static_cast<double>(half.opacity()), 0.5 * r.opacity, 4e-6) << i;
    // Not asked for, not given; and nothing else changes.
    const RayResult without = integrate(channels, ray, transfer, 1e-6);
    EXPECT_TRUE(std::isinf(without.half_opacity_depth));
    EXPECT_EQ(without.opacity, r.opacity);
    EXPECT_EQ(without.radiance.g, r.radiance.g);
  }
  EXPECT_GT(found, 30);
}

TEST(IntegrateMultivariateRay, ARayThatMissesIsClear) {
  Maker maker(114);
  const TestChannels channels = noise(maker, 4, 2);
  const TestTransfer transfer(maker, 2, 2, true);
  const RayResult r =
      integrate(channels, {{100, 0, 0}, {0, 0, 1}}, transfer, 1e-3, Grade::proved, true);
  EXPECT_EQ(r.error, 0);
  EXPECT_TRUE(r.proved);
  EXPECT_EQ(r.opacity, 0);
  EXPECT_EQ(r.cells, 0);
  EXPECT_TRUE(std::isinf(r.half_opacity_depth));
}

TEST(IntegrateMultivariateRay, ANaNOfOneChannelIsVacuumForAll) {
  Maker maker(115);
  TestChannels channels = noise(maker, 5, 3);
  const TestTransfer transfer(maker, 3, 3, true);
  const Ray<double> ray{{-1, 1.5, 1.5}, {1, 0, 0}};
  const RayResult whole = integrate(channels, ray, transfer, 1e-7);
  channels.at(1, 2, 2, 2) = nan;
  const RayResult found = integrate(channels, ray, transfer, 1e-7);
  const WideStretch truth = wide_ray(channels, ray, transfer);
  EXPECT_LE(ray_error(found, truth), static_cast<long double>(found.error) + 1e-13L);
  EXPECT_LT(found.opacity, whole.opacity);
  EXPECT_EQ(found.spans.skipped, whole.spans.skipped + 2);
  channels.fill([](int c, int, int, int) { return c == 2 ? nan : 0.5; });
  EXPECT_EQ(integrate(channels, ray, transfer, 1e-7).opacity, 0);
}

TEST(IntegrateMultivariateRay, ALooserToleranceTakesNoMoreWork) {
  Maker maker(116);
  const TestChannels channels = noise(maker, 17, 2);
  const TestTransfer transfer(maker, 2, 3, false);
  std::uint64_t work = 0;
  for (const double tolerance : {0.5, 1e-1, 1e-2, 1e-4, 1e-6}) {
    const RayResult r = integrate(channels, oblique_ray(17), transfer, tolerance);
    EXPECT_GE(r.spans.lines + r.spans.panels, work) << tolerance;
    work = r.spans.lines + r.spans.panels;
  }
}

/// A table of one channel and no Gaussian is what integrate_ray() sees.
TEST(IntegrateMultivariateRay, ATableAloneIsTheUnivariateRay) {
  Maker maker(117);
  TestTransfer transfer(maker, 1, 0, true);
  for (int i = 0; i < 60; ++i) {
    const TestGrid<float> grid(7);
    TestChannels channels(7, 7, 7, 1);
    channels.fill([&](int, int x, int y, int z) {
      return static_cast<double>(grid.data[static_cast<std::size_t>(x + 7 * (y + 7 * z))]);
    });
    const Ray<double> ray = random_ray(maker, 7);
    const RayResult one = exact_ray(grid, ray, Precision::float64, false, 1e-7);
    for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
      const RayResult other = integrate(channels, ray, transfer, tolerance);
      const double error = one.error + other.error;
      EXPECT_LE(other.error, tolerance);
      EXPECT_LE(std::abs(one.opacity - other.opacity), error);
      EXPECT_LE(std::abs(one.radiance.r - other.radiance.r), error);
      EXPECT_LE(std::abs(one.radiance.g - other.radiance.g), error);
      EXPECT_LE(std::abs(one.radiance.b - other.radiance.b), error);
    }
  }
}

TEST(IntegrateMultivariateRay, WorldLengthIsTheParameterNotTheGridLength) {
  TestChannels channels(3, 3, 3, 1);
  channels.fill([](int, int, int, int) { return 0.5; });
  Maker maker(118);
  TestTransfer transfer(maker, 1, 1, false);
  transfer.gaussians[0].center[0] = 0.5;
  const double peak = transfer.gaussians[0].peak;
  const RayResult r = integrate(channels, {{-1, 1, 1}, {0.5, 0, 0}}, transfer, 1e-9);
  EXPECT_NEAR(r.optical_depth, 4 * peak, 1e-13);
}

/// One block, one cell: what is left out of it is paid for by the same tolerance.
TEST(IntegrateMultivariateRay, WhatBlocksLeaveOutIsWithinTheTolerance) {
  Maker maker(119);
  ErrorRecord share("left out, error / reported", "");
  double nearest = 0;
  for (int i = 0; i < 400; ++i) {
    const TestChannels channels = noise(maker, 2, 1);
    TestTransfer transfer(maker, 1, 4, false);
    BlockField<double> field;
    field.set_cube(2, 0);
    field.fill([&](int x, int y, int z) { return channels.at(0, x, y, z); });
    field.build();
    const double tolerance = maker.powers(1e-4, 1e-1);
    // A primitive whose peak is as high as may be left out.
    const double left_out = tolerance / 32 / std::sqrt(3.0);
    transfer.gaussians[3].peak = left_out;
    const PrimitiveSet set{7};
    const BlockClass kind{0, BlockKind::cells, 0};
    const MultivariateBlocks blocks{field.blocks, {&kind}, &set, left_out};
    const Ray<double> ray = random_ray(maker, 2);
    const RayResult found =
        integrate(channels, ray, transfer, tolerance, Grade::proved, false, &blocks);
    const WideStretch truth = wide_ray(channels, ray, transfer);
    share.add(ray_error(found, truth) / (static_cast<long double>(found.error) + 1e-13L),
              std::to_string(i));
    EXPECT_LE(found.error, tolerance * (1 + 1e-12)) << i;
    nearest = std::max(nearest, found.error / tolerance);
    // All of it left out: as a block to skip.
    const BlockClass skip{0, BlockKind::skip, 0};
    const MultivariateBlocks nothing{field.blocks, {&skip}, &set, left_out};
    const RayResult skipped =
        integrate(channels, ray, transfer, tolerance, Grade::proved, false, &nothing);
    EXPECT_EQ(skipped.opacity, 0);
    EXPECT_LE(skipped.error, tolerance);
  }
  share.print();
  EXPECT_LE(share.largest(), 1);
  EXPECT_GT(nearest, 0.5);
}

}  // namespace
}  // namespace pellucid::test_integrate_multivariate_ray
