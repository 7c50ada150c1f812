// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "pellucid/render/sample_ray.h"
#include "tests/segment/wide_multivariate.h"

namespace pellucid::test_linear_steps {
namespace {

constexpr GaussianRule rules[] = {GaussianRule::kniss, GaussianRule::closed_form};

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
  RayResult march(int primitives, GaussianRule rule, double step, bool with_depth = false) const {
    return sample_linear_steps(grid(), {{-2, 0.5, 0.5}, {1, 0, 0}}, transfer(primitives), rule,
                               step, 1, 0, with_depth);
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
    const RayResult exact = slab.march(1, GaussianRule::closed_form, step);
    EXPECT_LT(worst(exact, one), 1e-12) << step;
    EXPECT_EQ(exact.cells, static_cast<long>(std::ceil(8 / step))) << step;
    const RayResult both = slab.march(2, GaussianRule::closed_form, step);
    EXPECT_NEAR(both.opacity, static_cast<double>(two.opacity()), 1e-12) << step;
    // The narrow one is not stepped over by Kniss's rule either.
    EXPECT_NEAR(slab.march(1, GaussianRule::kniss, step).opacity,
                static_cast<double>(one.opacity()), 1e-2)
        << step;
  }
  // A rule that sees materials steps over it.
  EXPECT_LT(sample_multivariate_ray(slab.grid(), {{-2, 0.5, 0.5}, {1, 0, 0}}, slab.transfer(1),
                                    SamplingRule::simpson, 2, 1, 0, false)
                .opacity,
            1e-6);
}

TEST(LinearSteps, ColorsConvergeWithTheSquareOfTheStep) {
  const Slab slab(9);
  const test::WideStretch truth = slab.truth(2);
  const auto error = [&](double step) {
    return worst(slab.march(2, GaussianRule::closed_form, step), truth);
  };
  EXPECT_GT(error(8), 1e-2);
  EXPECT_LT(error(0.002), 0.3 * error(0.004));
  EXPECT_LT(error(0.004), 1e-4);
  // Kniss's erf stops that: its error is divided by the widths of a step.
  const auto paper = [&](double step) {
    return worst(slab.march(2, GaussianRule::kniss, step), truth);
  };
  EXPECT_LT(paper(0.25), 1e-2);
  EXPECT_GT(paper(1e-3), 10 * error(1e-3));
}

TEST(LinearSteps, BentDataAreSeenAsChords) {
  const Slab slab(9, true);
  const test::WideStretch truth = slab.truth(2);
  for (const GaussianRule rule : rules) {
    EXPECT_LT(worst(slab.march(2, rule, 0.25), truth), 1e-2);
    EXPECT_GT(worst(slab.march(2, rule, 8), truth), 2e-2);
  }
  // Steps that are cells see the data as they are: an exact depth.
  EXPECT_NEAR(slab.march(2, GaussianRule::closed_form, 1).opacity,
              static_cast<double>(truth.opacity()), 1e-12);
}

TEST(LinearSteps, StepsThatEndInVacuumAreVacuum) {
  Slab slab(9);
  slab.primitive[1].matrix[0][0] = slab.primitive[1].matrix[1][1] = 0;  // constant 0.9
  // The cells from 3 to 5 are vacuum; of steps of 2 the second and the third end in them.
  slab.data[1][4] = std::numeric_limits<double>::quiet_NaN();
  MultivariateTransfer<double> transfer = slab.transfer(2);
  transfer.gaussians = {slab.primitive + 1, 1};
  const auto depth = [&](GaussianRule rule, double step) {
    return sample_linear_steps(slab.grid(), {{-2, 0.5, 0.5}, {1, 0, 0}}, transfer, rule, step, 1, 0,
                               false)
        .optical_depth;
  };
  for (const GaussianRule rule : rules) {
    EXPECT_NEAR(depth(rule, 2), 0.9 * 4, 1e-12);
    EXPECT_NEAR(depth(rule, 0.01), 0.9 * 6, 0.9 * 0.02 + 1e-9);
  }
}

TEST(LinearSteps, HalfOpacityDepthAndRaysThatMiss) {
  const Slab slab(9);
  for (const GaussianRule rule : rules) {
    const RayResult found = slab.march(1, rule, 0.01, true);
    // The sheet lies at 0.3137 of 8 cells, two in front of which the ray begins.
    EXPECT_NEAR(found.half_opacity_depth, 2 + 0.3137 * 8, 0.02);
    const RayResult missed = sample_linear_steps(slab.grid(), {{-2, 5, 0.5}, {1, 0, 0}},
                                                 slab.transfer(2), rule, 0.1, 1, 0, true);
    EXPECT_EQ(missed.opacity, 0);
    EXPECT_EQ(missed.cells, 0);
    EXPECT_TRUE(std::isinf(missed.half_opacity_depth));
  }
}

}  // namespace
}  // namespace pellucid::test_linear_steps
