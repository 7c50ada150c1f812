// SPDX-License-Identifier: Apache-2.0
#include "pellucid/segment/compositor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "pellucid/segment/constant.h"

namespace pellucid::test_fold {
namespace {

std::vector<SegmentResult<double>> some_segments(std::mt19937_64& random, int count,
                                                 double largest_depth) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<SegmentResult<double>> segments;
  for (int i = 0; i < count; ++i) {
    segments.push_back(constant_segment(largest_depth * std::pow(10.0, -6 * unit(random)),
                                        Rgb<double>{unit(random), unit(random), unit(random)},
                                        1.0));
  }
  return segments;
}

SegmentResult<double> fold_all(const std::vector<SegmentResult<double>>& segments) {
  FrontToBackCompositor<double> fold;
  for (const auto& s : segments) fold.add(s);
  return fold.result();
}

void expect_near(const SegmentResult<double>& a, const SegmentResult<double>& b, double tolerance) {
  EXPECT_NEAR(a.optical_depth, b.optical_depth, tolerance * std::max(1.0, b.optical_depth));
  EXPECT_NEAR(a.opacity, b.opacity, tolerance);
  EXPECT_NEAR(a.transparency, b.transparency, tolerance);
  EXPECT_NEAR(a.radiance.r, b.radiance.r, tolerance);
  EXPECT_NEAR(a.radiance.g, b.radiance.g, tolerance);
  EXPECT_NEAR(a.radiance.b, b.radiance.b, tolerance);
}

TEST(Compose, IsAssociativeWithIdentity) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const auto s = some_segments(random, 3, 5);
    expect_near(compose(compose(s[0], s[1]), s[2]), compose(s[0], compose(s[1], s[2])), 1e-15);
    const SegmentResult<double> nothing;
    expect_near(compose(nothing, s[0]), s[0], 0);
    expect_near(compose(s[0], nothing), s[0], 0);
  }
}

TEST(Compose, DoesNotCommute) {
  const auto red = constant_segment(1.0, Rgb<double>{1, 0, 0}, 1.0);
  const auto green = constant_segment(1.0, Rgb<double>{0, 1, 0}, 1.0);
  EXPECT_GT(compose(red, green).radiance.r, compose(green, red).radiance.r + 0.1);
}

/// A tree of any shape gives the fold's result.
TEST(FrontToBackCompositor, AgreesWithATreeReduction) {
  std::mt19937_64 random(2);
  for (const double depth : {1e-3, 0.1, 3.0}) {
    auto level = some_segments(random, 1000, depth);
    const SegmentResult<double> folded = fold_all(level);
    while (level.size() > 1) {
      std::vector<SegmentResult<double>> next;
      for (std::size_t i = 0; i + 1 < level.size(); i += 2) {
        next.push_back(compose(level[i], level[i + 1]));
      }
      if (level.size() % 2 == 1) next.push_back(level.back());
      level = next;
    }
    expect_near(folded, level[0], 4000 * rounding_unit<double>);
  }
}

/// Equation (3): whatever the errors of the segments, the pixel's is at most
/// Σ T_{<i} (e_i + C_max d_i). The errors are drawn at the bound, with signs that add up.
TEST(FrontToBackCompositor, ErrorOfAPixelIsBoundedByThatOfItsSegments) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  double largest_share = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const auto exact = some_segments(random, 100, 0.5);
    auto wrong = exact;
    const int pattern = trial % 3;
    double bound = 0, transparency = 1;
    for (auto& s : wrong) {
      const double e = 1e-3 * s.opacity * unit(random), d = 1e-3 * s.opacity * unit(random);
      const double sign = pattern == 0 ? 1 : pattern == 1 ? -1 : unit(random) < 0.5 ? -1 : 1;
      s.radiance.r += sign * e;
      s.opacity -= sign * d;  // less opaque: more from behind
      s.transparency = 1 - s.opacity;
      bound += transparency * (e + d);  // colors are <= 1
      transparency *= s.transparency;
    }
    const double error = std::abs(fold_all(wrong).radiance.r - fold_all(exact).radiance.r);
    ASSERT_LE(error, bound * (1 + 1e-9));
    largest_share = std::max(largest_share, error / bound);
    // The corollary: relative errors of 1e-3 give no more than 2e-3 of the opacity, for any number
    // of segments.
    ASSERT_LE(error, 2e-3 * fold_all(wrong).opacity);
  }
  EXPECT_GT(largest_share, 0.3);  // or the bound would say nothing
}

/// A million binary32 segments of opacity below u/2 = 3e-8: products of 1 - opacity in binary32
/// stay at 1 for ever; the fold becomes opaque as it should.
TEST(FrontToBackCompositor, ThinSegmentsDoNotStagnate) {
  const int count = 1 << 20;
  const float depth = 0x1p-26f;
  const SegmentResult<float> thin = constant_segment(depth, Rgb<float>{1, 0.5f, 0}, 1.0f);
  ASSERT_LT(thin.opacity, 0x1p-25f);
  FrontToBackCompositor<double> fold;
  float naive = 1;
  for (int i = 0; i < count; ++i) {
    fold.add(thin);
    naive *= 1 - thin.opacity;
  }
  EXPECT_EQ(naive, 1.0f);  // what the fold has to avoid
  const double truth = -std::expm1(-count * static_cast<double>(depth));
  EXPECT_NEAR(fold.opacity() / truth, 1, 8 * double(rounding_unit<float>));
  EXPECT_NEAR(fold.radiance().r / truth, 1, 8 * double(rounding_unit<float>));
  EXPECT_NEAR(fold.radiance().g / truth, 0.5, 8 * double(rounding_unit<float>));
  EXPECT_EQ(fold.optical_depth(), count * static_cast<double>(depth));
}

/// Opacity keeps its relative precision where 1 - transparency has none.
TEST(FrontToBackCompositor, ClearRaysKeepTheirOpacity) {
  FrontToBackCompositor<double> fold;
  for (int i = 0; i < 10; ++i) fold.add(constant_segment(1e-20, Rgb<double>{1, 1, 1}, 1.0));
  EXPECT_NEAR(fold.opacity() / 1e-19, 1, 1e-14);
  EXPECT_EQ(fold.transparency(), 1.0);
}

/// Optical depth and transparency keep what the opacity loses behind opaque fronts.
TEST(FrontToBackCompositor, OpaqueRaysKeepTheirDepth) {
  FrontToBackCompositor<double> fold;
  for (int i = 0; i < 100; ++i) fold.add(constant_segment(5.0, Rgb<double>{1, 1, 1}, 1.0));
  EXPECT_EQ(fold.optical_depth(), 500.0);
  EXPECT_NEAR(fold.transparency() / std::exp(-500.0), 1, 1e-13);
  EXPECT_EQ(fold.opacity(), 1.0);
  EXPECT_NEAR(fold.radiance().r, 1, 1e-15);
}

/// What an early end leaves out is at most stop · C_max in radiance and `stop` in opacity; what it
/// left in is not rescaled.
TEST(FrontToBackCompositor, EarlyOutLeavesOutNoMoreThanItSays) {
  std::mt19937_64 random(4);
  for (const double stop : {1e-2, 1e-4, 1e-8}) {
    double largest = 0;
    for (int trial = 0; trial < 100; ++trial) {
      const auto segments = some_segments(random, 400, 2);
      FrontToBackCompositor<double> fold(stop);
      int used = 0;
      for (const auto& s : segments) {
        fold.add(s);
        ++used;
        if (fold.done()) break;
      }
      const SegmentResult<double> all = fold_all(segments), some = fold.result();
      ASSERT_LE(all.opacity - some.opacity, stop);
      ASSERT_LE(all.radiance.r - some.radiance.r, stop);  // colors <= 1
      ASSERT_GE(all.radiance.r - some.radiance.r, -1e-15);
      if (used < 400) largest = std::max(largest, (all.opacity - some.opacity) / stop);
    }
    EXPECT_GT(largest, 0.1) << "the rule never ended a ray near its limit";
  }
}

TEST(FrontToBackCompositor, StopAtZeroEndsOnlyBehindWhatNothingPasses) {
  FrontToBackCompositor<double> fold;
  EXPECT_FALSE(fold.done());
  fold.add(constant_segment(100.0, Rgb<double>{1, 1, 1}, 1.0));
  EXPECT_FALSE(fold.done());
  fold.add(constant_segment(1e6, Rgb<double>{1, 1, 1}, 1.0));
  EXPECT_TRUE(fold.done());
}

}  // namespace
}  // namespace pellucid::test_fold
