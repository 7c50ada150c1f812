// SPDX-License-Identifier: Apache-2.0
#include "pellucid/error/budget.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace pellucid::test_budget {
namespace {

struct Span {
  double length, opacity;
};

/// Spends all that each span may, times `greed`; returns what the pixel is off by.
double spend_all(const std::vector<Span>& spans, double tolerance, double greed = 1) {
  double length = 0;
  for (const Span& span : spans) length += span.length;
  RayBudget<double> budget(tolerance, length);
  double transparency = 1, error = 0;
  for (const Span& span : spans) {
    if (!(transparency > 0)) break;
    const double x = greed * budget.allowance(span.length, span.opacity, transparency);
    EXPECT_GE(x, 0);
    error += transparency * x;
    budget.spend(span.length, span.opacity, transparency, x);
    transparency *= 1 - span.opacity;
  }
  EXPECT_NEAR(budget.spent(), error, 1e-12 * tolerance);
  return error;
}

TEST(RayBudget, NoSequenceOfSpansSpendsMoreThanTheTolerance) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  double most = 0;
  for (int round = 0; round < 20000; ++round) {
    const double thin = std::pow(10.0, -8 * unit(random));
    std::vector<Span> spans(std::uniform_int_distribution<std::size_t>(1, 60)(random));
    for (Span& span : spans) {
      span.length = unit(random) < 0.1 ? 0 : std::pow(10.0, -6 * unit(random));
      span.opacity = unit(random) < 0.05 ? 1 : unit(random) * thin;
    }
    const double tolerance = std::pow(10.0, -9 * unit(random));
    most = std::max(most, spend_all(spans, tolerance) / tolerance);
  }
  EXPECT_LE(most, 1 + 1e-12);
  EXPECT_GT(most, 0.95);  // and it is there to be spent
}

/// Spans tried sixteen at a time, some of them in vain, before those in front of them are folded.
TEST(RayBudget, NoSpansTriedTogetherSpendMoreThanTheTolerance) {
  struct Try {
    Span span;
    bool done = false;
    double from_opacity = 0, from_length = 0, error = 0;
  };
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> unit(0, 1);
  double most = 0;
  for (int round = 0; round < 5000; ++round) {
    const double thin = std::pow(10.0, -8 * unit(random));
    std::vector<Try> tries(std::uniform_int_distribution<std::size_t>(1, 60)(random));
    double length = 0;
    for (Try& one : tries) {
      one.span = {std::pow(10.0, -6 * unit(random)), unit(random) < 0.05 ? 1 : unit(random) * thin};
      length += one.span.length;
    }
    const double tolerance = std::pow(10.0, -9 * unit(random));
    RayBudget<double> budget(tolerance, length);
    double transparency = 1, error = 0;
    std::size_t front = 0;
    while (front < tries.size() && transparency > 0) {
      double left = budget.unreserved_opacity_budget();
      int tried = 0;
      for (std::size_t i = front; i < tries.size() && tried < 16; ++i) {
        Try& one = tries[i];
        if (one.done) continue;
        ++tried;
        const double from_opacity = left * one.span.opacity;
        left -= from_opacity;
        if (unit(random) < 0.3) continue;
        one.done = true;
        one.from_opacity = from_opacity;
        one.from_length = one.span.length * budget.allowance_per_length();
        one.error = (one.from_opacity + one.from_length) / transparency;
        budget.reserve(from_opacity);
      }
      for (; front < tries.size() && tries[front].done; ++front) {
        const Try& one = tries[front];
        error += transparency * one.error;
        budget.spend_reserved(one.span.length, one.from_opacity, one.from_length, transparency,
                              one.error);
        // At most as opaque as it was said to be.
        transparency *= 1 - one.span.opacity * unit(random);
      }
    }
    EXPECT_NEAR(budget.spent(), error, 1e-12 * tolerance);
    most = std::max(most, error / tolerance);
  }
  // What is left of the length is a rounded difference.
  EXPECT_LE(most - 1, 1e-9);
  EXPECT_GT(most, 0.9);
}

TEST(RayBudget, WhatLiesBehindARayThatIsOver) {
  RayBudget<double> budget(1e-3, 1);
  EXPECT_TRUE(budget.allows_termination(0.25e-3, 1e-3));
  EXPECT_FALSE(budget.allows_termination(0.26e-3, 1e-3));
  budget.spend(0.1, 0.5, 1, 2e-3);
  EXPECT_EQ(budget.remaining(), 0);
  EXPECT_TRUE(budget.allows_termination(1e-3 / 64, 1e-3));
  EXPECT_FALSE(budget.allows_termination(1e-3 / 63, 1e-3));
}

TEST(RayBudget, ThousandsOfThinSpansEachGetAFairShare) {
  const std::vector<Span> spans(4000, Span{0.01, 1e-7});
  const double tolerance = 1e-3;
  EXPECT_NEAR(spend_all(spans, tolerance), 0.5 * tolerance, 1e-3 * tolerance);
  RayBudget<double> budget(tolerance, 40);
  EXPECT_NEAR(budget.allowance(0.01, 0, 1), 0.5 * tolerance / 4000, 1e-15);
}

TEST(RayBudget, WhatIsLeftUnspentIsThereForTheNext) {
  const double tolerance = 1e-2;
  RayBudget<double> budget(tolerance, 2);
  EXPECT_EQ(budget.remaining(), tolerance);
  EXPECT_DOUBLE_EQ(budget.allowance(1, 0, 1), 0.25 * tolerance);
  budget.spend(1, 0.25, 1, 0);
  EXPECT_EQ(budget.remaining(), tolerance);
  EXPECT_DOUBLE_EQ(budget.remaining_length(), 1);
  // An opaque last span may take all, and more the less of it is seen.
  EXPECT_DOUBLE_EQ(budget.allowance(1, 1, 0.75), tolerance / 0.75);
}

TEST(RayBudget, OverspendingIsCountedAndLeavesNothing) {
  RayBudget<double> budget(1e-3, 1);
  budget.spend(0.5, 0.5, 1, 1);
  EXPECT_EQ(budget.spent(), 1);
  EXPECT_EQ(budget.remaining(), 0);
  EXPECT_EQ(budget.allowance(0.5, 0.5, 0.5), 0);
  EXPECT_GT(spend_all({{1, 0.5}, {1, 0.5}}, 1e-3, 4), 1.5e-3);
}

TEST(RayBudget, WhatOnePotLacksComesFromTheOther) {
  RayBudget<double> budget(1, 1);
  // More than a span so thin may take, but less than there is.
  budget.spend(0.5, 0, 1, 0.75);
  EXPECT_DOUBLE_EQ(budget.remaining(), 0.25);
  budget.spend(0.25, 1, 1, 0.25);
  EXPECT_DOUBLE_EQ(budget.remaining(), 0);
  EXPECT_DOUBLE_EQ(budget.spent(), 1);
}

TEST(RayBudget, LosesWhatASpanCostsAndNoMore) {
  for (const double opacity : {0.0, 0.3, 1.0}) {
    for (const double length : {0.0, 0.2, 1.0}) {
      for (const double share_of_left : {0.0, 0.25, 0.9, 1.0}) {
        RayBudget<double> budget(1e-2, 1);
        budget.spend(0, 1, 1, 4e-3);  // pots that are not alike
        const auto shares = budget.span_share(length, opacity);
        EXPECT_DOUBLE_EQ(shares.sum(), budget.allowance(length, opacity, 1));
        const double left = budget.remaining(), cost = share_of_left * left;
        budget.spend(length, shares, cost);
        EXPECT_NEAR(budget.remaining(), left - cost, 1e-15) << opacity << ", " << length;
        EXPECT_GE(budget.remaining(), 0);
        EXPECT_GE(budget.allowance(1, 0, 1), 0);
        EXPECT_GE(budget.allowance(0, 1, 1), 0);
        EXPECT_DOUBLE_EQ(budget.spent(), 4e-3 + cost);
      }
    }
  }
}

TEST(RayBudget, EdgesAreFinite) {
  RayBudget nothing(0, 0);
  EXPECT_EQ(nothing.allowance(0, 0, 1), 0);
  nothing.spend(0, 0, 1, 0);
  EXPECT_EQ(nothing.remaining(), 0);
  // The last span is as long as what is left, up to rounding.
  RayBudget<double> budget(1, 0.3);
  budget.spend(0.1, 0, 1, 0);
  budget.spend(0.1, 0, 1, 0);
  EXPECT_NEAR(budget.allowance(0.1, 0, 1), 0.5, 1e-15);
  budget.spend(0.1, 0, 1, 0);
  EXPECT_LE(budget.remaining_length(), 1e-16);
  EXPECT_LE(budget.allowance(0.1, 1, 1), 1);
}

}  // namespace
}  // namespace pellucid::test_budget
