// SPDX-License-Identifier: Apache-2.0
#include "pellucid/segment/gaussian_step.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/segment/wide_gaussian.h"

namespace pellucid::test_gaussian_step {
namespace {

constexpr GaussianRule rules[] = {GaussianRule::kniss, GaussianRule::closed_form};

/// Two channels, two primitives of different color, of which each sees its own part of the data.
struct TwoPrimitives {
  std::array<Gaussian<double>, 2> primitive;
  MultivariateTransfer<double> transfer;
  double v1[2] = {0.1, 0.9}, v2[2] = {0.6, 0.3};

  TwoPrimitives() {
    for (Gaussian<double>& g : primitive) {
      g.channels = 2;
      g.rows = 2;
      g.matrix[0][0] = 3;
      g.matrix[0][1] = -1;
      g.matrix[1][1] = 2;
    }
    primitive[0].center[0] = 0.2;
    primitive[0].center[1] = 0.8;
    primitive[0].peak = 1.5;
    primitive[0].color = {1, 0.5, 0};
    primitive[1].center[0] = 0.7;
    primitive[1].center[1] = 0.2;
    primitive[1].peak = 4;
    primitive[1].color = {0, 0.25, 2};
    transfer.gaussians = {primitive.data(), 2};
    transfer.channels = 2;
  }
  TwoPrimitives(const TwoPrimitives&) = delete;  // the view points into it
  TwoPrimitives& operator=(const TwoPrimitives&) = delete;
};

/// Kniss (12) with (25) as they stand on paper, by the distances of the ends in widths along a line
/// through the center: one channel, K = 1, c = 0.
long double kniss_on_paper(long double from, long double to) {
  const auto erf_25 = [](long double x) {
    const long double t = 1 / (1 + 0.47047L * std::fabs(x));
    const long double y =
        1 - (0.3480242L * t - 0.0958798L * t * t + 0.7478556L * t * t * t) * std::exp(-x * x);
    return x < 0 ? -y : y;
  };
  return std::sqrt(std::acos(-1.0L)) / 2 * (erf_25(to) - erf_25(from)) / (to - from);
}

TEST(GaussianStep, DepthIsTheSumAndColorTheMeanByDepth) {
  const TwoPrimitives two;
  const double length = 0.8;
  long double mass[2];
  for (std::size_t i = 0; i < 2; ++i) {
    mass[i] = static_cast<long double>(two.primitive[i].peak) * static_cast<long double>(length) *
              static_cast<long double>(test::wide_mean_density(two.primitive[i], two.v1, two.v2));
  }
  const long double depth = mass[0] + mass[1], alpha = -std::expm1(-depth);
  ASSERT_GT(mass[0], 0.1L);
  ASSERT_GT(mass[1], 0.1L);
  const SegmentResult<double> exact =
      mean_color_segment(GaussianRule::closed_form, two.transfer, two.v1, two.v2, length);
  const auto near = [](double found, long double truth, double error) {
    EXPECT_NEAR(found, static_cast<double>(truth), error);
  };
  near(exact.optical_depth, depth, 1e-15);
  near(exact.opacity, alpha, 1e-15);
  near(exact.transparency, 1 - alpha, 1e-15);
  near(exact.radiance.r, alpha * mass[0] / depth, 1e-15);
  near(exact.radiance.g, alpha * (0.5L * mass[0] + 0.25L * mass[1]) / depth, 1e-15);
  near(exact.radiance.b, alpha * 2 * mass[1] / depth, 1e-15);

  const SegmentResult<double> paper =
      mean_color_segment(GaussianRule::kniss, two.transfer, two.v1, two.v2, length);
  near(paper.optical_depth, depth, 1e-4);
  EXPECT_GT(std::fabs(paper.optical_depth - exact.optical_depth), 1e-8);
  near(paper.radiance.b, alpha * 2 * mass[1] / depth, 1e-4);
}

TEST(GaussianStep, KnissIsTheFormulaOfThePaper) {
  Gaussian<double> g;
  g.matrix[0][0] = 1;
  g.peak = 1;
  g.color = {1, 1, 1};
  MultivariateTransfer<double> transfer;
  transfer.gaussians = {&g, 1};
  for (const auto& [from, to] : {std::pair{-1.0, 1.0}, {0.0, 3.0}, {0.5, 0.6}, {2.0, -0.7}}) {
    const double depth =
        mean_color_segment(GaussianRule::kniss, transfer, &from, &to, 1.0).optical_depth;
    EXPECT_NEAR(depth,
                static_cast<double>(
                    kniss_on_paper(static_cast<long double>(from), static_cast<long double>(to))),
                1e-14)
        << from << " " << to;
    EXPECT_GT(std::fabs(depth - static_cast<double>(test::wide_mean_density(g, &from, &to))), 1e-8);
  }
}

/// Extinction 4 v in front of 1 and 0 behind, color from red to green.
struct Ramp {
  double value[3] = {0, 1, 1};
  Material<double> material[3] = {{0, {1, 0, 0}}, {4, {0, 1, 0}}, {0, {0, 1, 0}}};
  ChannelTable<double> table{1, {value, material, 3}};
};

TEST(GaussianStep, TableAloneIsExact) {
  const Ramp ramp;
  MultivariateTransfer<double> transfer;
  transfer.table = &ramp.table;
  transfer.tables = 1;
  transfer.channels = 2;
  // Half of the way lies within the ramp.
  const double v1[2] = {7, 0}, v2[2] = {-7, 2};
  const double depth = 2;  // ∫ 4 v over half of a length of 2
  const double alpha = -std::expm1(-depth);
  // The green is ∫ v · 4 v e^(-2 v²) dv = √(π/8) erf(√2) - e^-2.
  const double green = std::sqrt(std::acos(-1.0) / 8) * std::erf(std::sqrt(2.0)) - std::exp(-2.0);
  for (const GaussianRule rule : rules) {
    const SegmentResult<double> s = mean_color_segment(rule, transfer, v1, v2, 2.0);
    EXPECT_NEAR(s.optical_depth, depth, 1e-15);
    EXPECT_NEAR(s.opacity, alpha, 1e-15);
    EXPECT_NEAR(s.radiance.g, green, 1e-14);
    EXPECT_NEAR(s.radiance.r, alpha - green, 1e-14);
  }
}

TEST(GaussianStep, TableAndPrimitivesAreWeightedByDepth) {
  const Ramp ramp;
  TwoPrimitives two;
  two.transfer.table = &ramp.table;
  two.transfer.tables = 1;
  two.v1[1] = two.v2[1] = 0.5;  // a constant segment of extinction 2 in the ramp's mean color
  const double length = 0.3, table = 2 * length;
  for (const GaussianRule rule : rules) {
    MultivariateTransfer<double> alone = two.transfer;
    alone.tables = 0;
    const SegmentResult<double> g = mean_color_segment(rule, alone, two.v1, two.v2, length);
    const SegmentResult<double> both =
        mean_color_segment(rule, two.transfer, two.v1, two.v2, length);
    EXPECT_NEAR(both.optical_depth, g.optical_depth + table, 1e-15);
    const double red =
        (g.optical_depth * g.radiance.r / g.opacity + table * 0.5) / (g.optical_depth + table);
    EXPECT_NEAR(both.radiance.r, both.opacity * red, 1e-15);
  }
}

TEST(GaussianStep, NothingSeenIsClear) {
  TwoPrimitives two;
  const Ramp ramp;
  two.transfer.table = &ramp.table;
  two.transfer.tables = 1;
  const double far[2] = {1e3, 2e3};
  for (const GaussianRule rule : rules) {
    for (const double length : {0.0, 1.0}) {
      const SegmentResult<double> s = mean_color_segment(rule, two.transfer, far, far, length);
      EXPECT_EQ(s.opacity, 0);
      EXPECT_EQ(s.transparency, 1);
      EXPECT_EQ(s.radiance, Rgb<double>{});
    }
    const SegmentResult<double> s = mean_color_segment(rule, two.transfer, two.v1, two.v2, 0.0);
    EXPECT_EQ(s.opacity, 0);
    EXPECT_EQ(s.radiance, Rgb<double>{});
  }
}

}  // namespace
}  // namespace pellucid::test_gaussian_step
