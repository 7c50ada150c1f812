// SPDX-License-Identifier: Apache-2.0
#include "pellucid/segment/sampled.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace pellucid::test_sampled {
namespace {

using Wide = long double;

/// A wave of one quantity along the ray: mean + amplitude sin(frequency t + phase).
struct Wave {
  double mean, amplitude, frequency, phase;
  Wide at(Wide t) const { return mean + amplitude * std::sin(frequency * t + phase); }
};

struct Medium {
  Wave extinction, red, green, blue;
  Material<double> at(Wide t) const {
    return {static_cast<double>(extinction.at(t)),
            {static_cast<double>(red.at(t)), static_cast<double>(green.at(t)),
             static_cast<double>(blue.at(t))}};
  }
};

struct Truth {
  Wide depth, opacity, radiance[3];
};

/// The optical depth in closed form, the rest by Gauss-Legendre panels so narrow that they are
/// exact to long double.
Truth truth_of(const Medium& m, Wide length) {
  const Wave& e = m.extinction;
  const auto depth = [&](Wide t) {
    if (e.frequency == 0) return static_cast<Wide>(e.mean) * t;
    return e.mean * t - e.amplitude / static_cast<Wide>(e.frequency) *
                            (std::cos(e.frequency * t + e.phase) - std::cos(Wide{e.phase}));
  };
  constexpr Wide node[] = {0.9061798459386639928L, 0.5384693101056830910L, 0};
  constexpr Wide weight[] = {0.2369268850561890875L, 0.4786286704993664680L,
                             0.5688888888888888889L};
  Truth r{depth(length), -std::expm1(-depth(length)), {0, 0, 0}};
  constexpr int panels = 40;
  const Wide half = length / panels / 2;
  for (int p = 0; p < panels; ++p) {
    for (int n = -2; n <= 2; ++n) {
      const Wide t = (2 * p + 1) * half + (n < 0 ? -1 : 1) * half * node[2 - std::abs(n)];
      const Wide w = half * weight[2 - std::abs(n)] * e.at(t) * std::exp(-depth(t));
      r.radiance[0] += w * m.red.at(t);
      r.radiance[1] += w * m.green.at(t);
      r.radiance[2] += w * m.blue.at(t);
    }
  }
  return r;
}

SampledSegment<double> sampled(const Medium& m, double step) {
  std::array<Material<double>, 5> at{};
  for (std::size_t i = 0; i < 5; ++i) at[i] = m.at(static_cast<Wide>(i) * step);
  return sampled_segment(at.data(), step);
}

/// The largest error of what `difference` speaks of.
double error_of(const SegmentResult<double>& s, const Truth& truth) {
  const double found[] = {s.opacity, s.radiance.r, s.radiance.g, s.radiance.b};
  const Wide wanted[] = {truth.opacity, truth.radiance[0], truth.radiance[1], truth.radiance[2]};
  double largest = 0;
  for (int i = 0; i < 4; ++i) {
    largest = std::max(largest, static_cast<double>(std::fabs(found[i] - wanted[i])));
  }
  return largest;
}

class SampledSegments : public testing::Test {
 protected:
  double uniform(double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random_);
  }
  /// Waves no shorter than so much.
  Wave wave(double mean, double shortest) {
    const double frequency = 2 * 3.14159265358979 / (shortest * uniform(1, 8));
    return {mean, mean * uniform(0, 0.9), frequency, uniform(0, 6.3)};
  }
  Medium medium(double extinction, double shortest) {
    return {wave(extinction, shortest), wave(0.5, shortest), wave(0.5, shortest),
            wave(0.5, shortest)};
  }
  std::mt19937 random_{5};
};

TEST_F(SampledSegments, AreOfFourthOrderByLength) {
  // The error of a segment: one order more.
  for (int n = 0; n < 50; ++n) {
    const Medium m = medium(1, 6);
    const double coarse = error_of(sampled(m, 0.1).segment, truth_of(m, 0.4L)),
                 fine = error_of(sampled(m, 0.05).segment, truth_of(m, 0.2L));
    if (coarse < 1e-10) continue;  // it passes through zero nearby
    EXPECT_LT(fine, coarse / 12) << n;
  }
}

TEST_F(SampledSegments, ErrAsMuchAsASixteenthOfTheDifferenceWhereSmooth) {
  double worst = 0;
  for (int n = 0; n < 300; ++n) {
    const Medium m = medium(uniform(0.01, 1), 10);
    const SampledSegment<double> s = sampled(m, 0.1);
    const double error = error_of(s.segment, truth_of(m, 0.4L));
    if (s.difference > 1e-9) worst = std::max(worst, error / s.difference);
  }
  EXPECT_LT(worst, 0.125);
  EXPECT_GT(worst, 0.03);  // or it was measured against nothing
}

TEST_F(SampledSegments, ErrLessThanTheDifferenceUpToTheLongestSteps) {
  // Waves of three steps, and up to an optical depth of 1 for each of them: what is charged is four
  // thirds of the difference.
  int over = 0;
  constexpr int all = 2000;
  for (int n = 0; n < all; ++n) {
    const Medium m = medium(uniform(0.01, 0.5), 3);
    const SampledSegment<double> s = sampled(m, 1);
    const double error = error_of(s.segment, truth_of(m, 4));
    if (error > 4.0 / 3 * s.difference) ++over;
    EXPECT_LT(error, 4.0 / 3 * s.difference + 0.02) << n;
  }
  EXPECT_LT(over, all / 20);
}

TEST_F(SampledSegments, KnowTheCornerOfALine) {
  // One corner of the extinction, wherever it is, is charged for.
  for (int n = 1; n < 400; ++n) {
    const double corner = 0.01 * n;
    std::array<Material<double>, 5> at{};
    constexpr double small =
        1e-6;  // nothing is absorbed on the way: the integral is that of a line
    for (std::size_t i = 0; i < 5; ++i) {
      at[i] = {small * std::max(0.0, static_cast<double>(i) - corner), {1, 1, 1}};
    }
    const SampledSegment<double> s = sampled_segment(at.data(), 1.0);
    const double depth = small * (4 - corner) * (4 - corner) / 2;
    EXPECT_LE(std::fabs(s.segment.opacity + std::expm1(-depth)), 1.34 * s.difference + 1e-11)
        << corner;
  }
}

TEST_F(SampledSegments, AreExactWhereNothingChanges) {
  for (const double extinction : {0.0, 1e-300, 1e-6, 1.0, 50.0}) {
    for (const double step : {0.0, 1e-30, 1e-3, 1.0, 10.0}) {
      if (extinction * step > 1) continue;
      std::array<Material<double>, 5> at{};
      at.fill({extinction, {0.25, 0.5, 1}});
      const SampledSegment<double> s = sampled_segment(at.data(), step);
      const double opacity = -std::expm1(-4 * extinction * step);
      EXPECT_NEAR(s.segment.opacity, opacity, 1e-15) << extinction << " " << step;
      EXPECT_NEAR(s.segment.transparency, 1 - opacity, 1e-15);
      EXPECT_NEAR(s.segment.radiance.r, 0.25 * opacity, 1e-15);
      EXPECT_NEAR(s.segment.radiance.b, opacity, 1e-15);
      EXPECT_LE(s.difference, 1e-15);
      EXPECT_DOUBLE_EQ(s.segment.optical_depth, 4 * extinction * step);
    }
  }
}

TEST_F(SampledSegments, AreNumbersWhateverTheMaterials) {
  for (int n = 0; n < 2000; ++n) {
    std::array<Material<float>, 5> at{};
    for (Material<float>& m : at) {
      const double extinction = uniform(0, 1) < 0.3 ? 0 : std::pow(10.0, uniform(-30, 12));
      m = {static_cast<float>(extinction),
           {static_cast<float>(uniform(0, 1)), static_cast<float>(uniform(0, 1)), 0}};
    }
    const auto step = static_cast<float>(std::pow(10.0, uniform(-12, 6)));
    const SampledSegment<float> s = sampled_segment(at.data(), step);
    EXPECT_TRUE(std::isfinite(s.difference));
    EXPECT_GE(s.segment.opacity, 0.0f);
    EXPECT_LE(s.segment.opacity, 1.000001f);
    EXPECT_GE(s.segment.transparency, 0.0f);
    EXPECT_GE(s.segment.radiance.r, 0.0f);
    EXPECT_TRUE(std::isfinite(s.segment.radiance.r) && std::isfinite(s.segment.radiance.g));
    EXPECT_EQ(s.segment.radiance.b, 0.0f);
  }
}

}  // namespace
}  // namespace pellucid::test_sampled
