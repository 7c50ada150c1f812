// SPDX-License-Identifier: Apache-2.0
#include "pellucid/math/solve_monotone.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

namespace pellucid {
namespace {

struct Found {
  double at;
  int calls;
};

template <class Function>
Found find(Function&& f, double target, double lo, double hi) {
  int calls = 0;
  const auto counted = [&](double x) {
    ++calls;
    return f(x);
  };
  return {solve_monotone(counted, target, lo, hi, f(lo), f(hi)), calls};
}

TEST(WhereReached, FindsCurvesInFewSteps) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  double worst = 0, calls = 0;
  constexpr int count = 20000;
  for (int n = 0; n < count; ++n) {
    // x^p, and steps of erf's shape somewhere, as a narrow Gaussian's depth is.
    const double p = std::exp(unit(random) * 6 - 3), lo = unit(random),
                 hi = lo + 0.1 + unit(random);
    const double middle = lo + unit(random) * (hi - lo), width = std::pow(10.0, -3 * unit(random));
    const bool step = n % 2 == 0;
    const auto f = [&](double x) {
      return step ? std::erf((x - middle) / width) + 1e-3 * x
                  : std::pow(std::max((x - lo) / (hi - lo), 0.0), p);
    };
    const double share = 1e-6 + (1 - 2e-6) * unit(random), below = f(lo), above = f(hi);
    const double target = below + share * (above - below);
    const Found found = find(f, target, lo, hi);
    calls += found.calls;
    EXPECT_LE(found.calls, 130);
    const double off = std::fabs(f(found.at) - target) / (above - below);
    // Near enough in f, or between two places that are near to each other.
    if (off > 0x1p-44) {
      const double aside = 0x1p-40 * (hi - lo);
      EXPECT_LE(f(found.at - aside), target + 1e-15);
      EXPECT_GE(f(found.at), target - 1e-15);
    }
    worst = std::max(worst, off);
  }
  std::printf("%.2f calls in the mean, f off by %.2g of its range at most\n", calls / count, worst);
  EXPECT_LE(calls / count, 18);
}

/// Where an interval holds few numbers.
TEST(WhereReached, EndsInNarrowIntervals) {
  for (double width = 1e-3; width > 1e-17; width /= 3) {
    const double lo = 0.7, hi = lo + width;
    if (!(hi > lo)) break;
    for (int n = 1; n <= 200; ++n) {
      const auto f = [&](double x) { return (x - lo) / (hi - lo); };
      const Found found = find(f, n / 200.0, lo, hi);
      EXPECT_LE(found.calls, 130);
      EXPECT_NEAR(found.at, lo + n / 200.0 * width, 2e-12 * width + 0x1p-52);
    }
  }
}

TEST(WhereReached, FindsJumpsAndFlats) {
  const auto jump = [](double x) { return x < 0.3 ? 0.0 : 1.0; };
  const Found found = find(jump, 0.5, 0, 1);
  EXPECT_NEAR(found.at, 0.3, 0x1p-40);
  EXPECT_LE(found.calls, 120);
  const auto flat = [](double x) { return std::fmax(x - 0.75, 0.0); };
  EXPECT_NEAR(find(flat, 1e-9, 0, 1).at, 0.75, 2e-9);
  // f(hi) is the target itself.
  EXPECT_NEAR(find([](double x) { return x; }, 1, 0, 1).at, 1, 1e-12);
}

}  // namespace
}  // namespace pellucid
