// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "pellucid/field/multichannel_grid.h"
#include "pellucid/render/ray_result.h"
#include "pellucid/segment/compositor.h"
#include "pellucid/segment/segment_rule.h"
#include "tests/segment/wide_multivariate.h"

namespace pellucid::test_linear_steps {
namespace {

constexpr SegmentRule rules[] = {SegmentRule::kniss, SegmentRule::gaussian};

/// What data_segment() makes of steps along x through the middle of a grid of some cells, from two
/// units in front of it.
RayResult march_steps(const MultichannelGrid& grid, const MultivariateTransfer<double>& transfer,
                      SegmentRule rule, double step) {
  FrontToBackCompositor<double> fold;
  const double last = grid.axis[0].cells();
  double from[max_channels], to[max_channels];
  bool is_filled = grid.sample<double>({0, 0.5, 0.5}, from);
  RayResult result;
  for (double begin = 0, end = 0; begin < last; begin = end) {
    end = std::min(static_cast<double>(++result.cells) * step, last);
    const bool was_filled = is_filled;
    is_filled = grid.sample<double>({end, 0.5, 0.5}, to);
    if (was_filled && is_filled) {
      fold.add(data_segment(rule, PreintegratedTable{}, 1.0, transfer, from, to, end - begin));
    }
    std::copy_n(to, grid.channels, from);
  }
  result.radiance = fold.radiance();
  result.opacity = fold.opacity();
  result.optical_depth = fold.optical_depth();
  return result;
}

/// Two channels of n × 2 × 2 values each: x and, if bent, x² in units of the whole; a narrow
/// primitive in front of a wide one.
struct Slab {
  int n;
  std::vector<double> data[2];
  Gaussian<double> primitive[2];

  explicit Slab(int points, bool bent = false) : n(points) {
    for (int i = 0; i < 4 * n; ++i) {
      const double x = static_cast<double>(i % n) / (n - 1);
      data[0].push_back(x);
      data[1].push_back(bent ? x * x : 1 - 2 * x);
    }
    for (Gaussian<double>& g : primitive) {
      g.channels = 2;
      g.rows = 2;
    }
    primitive[0].matrix[0][0] = 300;
    primitive[0].center[0] = 0.3137;
    primitive[0].peak = 40;
    primitive[0].color = {1, 0.5, 0.25};
    primitive[1].matrix[0][0] = 4;
    primitive[1].matrix[1][1] = 3;
    primitive[1].center[0] = 0.6;
    primitive[1].center[1] = 0.1;
    primitive[1].peak = 0.9;
    primitive[1].color = {0, 0.75, 1};
  }
  MultichannelGrid grid() const {
    MultichannelGrid result;
    result.channels = 2;
    for (int c = 0; c < 2; ++c) {
      result.data[c] = data[c].data();
      result.type[c] = ValueType::f64;
    }
    result.axis[0] = {nullptr, n, 0};
    result.axis[1] = result.axis[2] = {nullptr, 2, 0};
    return result;
  }
  MultivariateTransfer<double> transfer(int primitives) const {
    MultivariateTransfer<double> result;
    result.gaussians = {primitive, primitives};
    result.channels = 2;
    return result;
  }
  /// Along x through the middle, from outside.
  RayResult march(int primitives, SegmentRule rule, double step) const {
    return march_steps(grid(), transfer(primitives), rule, step);
  }
  /// The data are linear from cell to cell: each a stretch of its own.
  test::WideStretch truth(int primitives) const {
    const MultivariateTransfer<double> view = transfer(primitives);
    test::WideStretch sum;
    for (std::size_t i = 0; i + 1 < static_cast<std::size_t>(n); ++i) {
      MultivariateSpan<double> span;
      span.length = 1;
      for (int c = 0; c < 2; ++c) {
        const double a = data[c][i], b = data[c][i + 1];
        span.data[c] = {{a, a + (b - a) / 3, b - (b - a) / 3, b}};
      }
      sum.add(test::wide_multivariate(view, span));
    }
    return sum;
  }
};

double worst(const RayResult& found, const test::WideStretch& truth) {
  const auto off = [](double x, long double y) {
    return static_cast<double>(std::fabs(static_cast<long double>(x) - y));
  };
  return std::max({off(found.opacity, truth.opacity()), off(found.radiance.r, truth.radiance[0]),
                   off(found.radiance.g, truth.radiance[1]),
                   off(found.radiance.b, truth.radiance[2])});
}

TEST(LinearSteps, LinearDataHaveTheirDepthAtAnyStep) {
  const Slab slab(9);
  const test::WideStretch one = slab.truth(1), two = slab.truth(2);
  ASSERT_GT(one.opacity(), 0.5L);
  for (const double step : {0.01, 0.37, 2.5, 8.0, 100.0}) {
    const RayResult exact = slab.march(1, SegmentRule::gaussian, step);
    EXPECT_LT(worst(exact, one), 1e-12) << step;
    EXPECT_EQ(exact.cells, static_cast<long>(std::ceil(8 / step))) << step;
    const RayResult both = slab.march(2, SegmentRule::gaussian, step);
    EXPECT_NEAR(both.opacity, static_cast<double>(two.opacity()), 1e-12) << step;
    // The narrow one is not stepped over by Kniss's rule either.
    EXPECT_NEAR(slab.march(1, SegmentRule::kniss, step).opacity, static_cast<double>(one.opacity()),
                1e-2)
        << step;
  }
}

TEST(LinearSteps, ColorsConvergeWithTheSquareOfTheStep) {
  const Slab slab(9);
  const test::WideStretch truth = slab.truth(2);
  const auto error = [&](double step) {
    return worst(slab.march(2, SegmentRule::gaussian, step), truth);
  };
  EXPECT_GT(error(8), 1e-2);
  EXPECT_LT(error(0.002), 0.3 * error(0.004));
  EXPECT_LT(error(0.004), 1e-4);
  // Kniss's erf stops that: its error is divided by the widths of a step.
  const auto paper = [&](double step) {
    return worst(slab.march(2, SegmentRule::kniss, step), truth);
  };
  EXPECT_LT(paper(0.25), 1e-2);
  EXPECT_GT(paper(1e-3), 10 * error(1e-3));
}

TEST(LinearSteps, BentDataAreSeenAsChords) {
  const Slab slab(9, true);
  const test::WideStretch truth = slab.truth(2);
  for (const SegmentRule rule : rules) {
    EXPECT_LT(worst(slab.march(2, rule, 0.25), truth), 1e-2);
    EXPECT_GT(worst(slab.march(2, rule, 8), truth), 2e-2);
  }
  // Steps that are cells see the data as they are: an exact depth.
  EXPECT_NEAR(slab.march(2, SegmentRule::gaussian, 1).opacity, static_cast<double>(truth.opacity()),
              1e-12);
}

TEST(LinearSteps, StepsOfAConstantPrimitiveAddUp) {
  Slab slab(9);
  slab.primitive[1].matrix[0][0] = slab.primitive[1].matrix[1][1] = 0;  // constant 0.9
  // The cells from 3 to 5 are vacuum; of steps of 2 the second and the third end in them.
  slab.data[1][4] = std::numeric_limits<double>::quiet_NaN();
  MultivariateTransfer<double> transfer = slab.transfer(2);
  transfer.gaussians = {slab.primitive + 1, 1};
  const auto depth = [&](SegmentRule rule, double step) {
    return march_steps(slab.grid(), transfer, rule, step).optical_depth;
  };
  for (const SegmentRule rule : rules) {
    EXPECT_NEAR(depth(rule, 2), 0.9 * 4, 1e-12);
    EXPECT_NEAR(depth(rule, 0.01), 0.9 * 6, 0.9 * 0.02 + 1e-9);
  }
}

}  // namespace
}  // namespace pellucid::test_linear_steps
