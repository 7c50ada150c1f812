// SPDX-License-Identifier: Apache-2.0
#include "pellucid/geometry/box.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace pellucid::test_box {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double denormal = std::numeric_limits<double>::denorm_min();
constexpr Box<double> box{{0, 0, 0}, {1, 2, 3}};

void expect_hit(const Ray<double>& ray, double begin, double end) {
  const Interval<double> t = intersect(box, ray);
  EXPECT_FALSE(t.empty());
  EXPECT_EQ(t.begin, begin);
  EXPECT_EQ(t.end, end);
}
void expect_miss(const Ray<double>& ray) {
  EXPECT_TRUE(intersect(box, ray).empty());
}

TEST(Box, AxisParallelEitherWayAndEitherZero) {
  for (const double zero : {0.0, -0.0}) {
    expect_hit({{-1, 1, 1}, {1, zero, zero}}, 1, 2);
    expect_hit({{-1, 1, 1}, {-0.5, zero, zero}}, -4, -2);
    expect_hit({{0.5, 5, 1}, {zero, -1, zero}}, 3, 5);
    expect_miss({{-1, 3, 1}, {1, zero, zero}});
    expect_miss({{-1, 1, -1e-300}, {1, zero, zero}});
  }
}

TEST(Box, FacesEdgesAndCornersAreInside) {
  for (const double zero : {0.0, -0.0}) {
    expect_hit({{-1, 0, 1}, {1, zero, zero}}, 1, 2);  // in a face
    expect_hit({{-1, 2, 1}, {1, zero, zero}}, 1, 2);
    expect_hit({{-1, 2, 3}, {1, zero, zero}}, 1, 2);  // along an edge
    expect_hit({{0, 0, 0}, {zero, zero, 1}}, 0, 3);   // along an edge, from a corner
    expect_miss({{-1, std::nextafter(2.0, 3.0), 1}, {1, zero, zero}});
    expect_miss({{-1, -denormal, 1}, {1, zero, zero}});
  }
  expect_hit({{-1, 1, 1}, {1, -1, 0}}, 1, 1);  // through an edge
  expect_hit({{-1, -1, -1}, {1, 1, 1}}, 1, 2);
  expect_hit({{2, -1, 0}, {-1, 1, 0}}, 1, 2);
}

TEST(Box, OriginInside) {
  expect_hit({{0.5, 0.5, 0.5}, {1, 0, 0}}, -0.5, 0.5);
  expect_hit({{0, 1, 1}, {1, 0, 0}}, 0, 1);
  expect_hit({{0, 1, 1}, {-1, 0, 0}}, -1, 0);
}

TEST(Box, VanishingAndOverflowingComponents) {
  for (const double tiny : {denormal, -denormal, 1e-310, -1e-310}) {
    expect_hit({{-1, 1, 1}, {1, tiny, 0}}, 1, 2);
    expect_miss({{-1, 3, 1}, {1, tiny, 0}});
    // On a face: the plane is met at t = 0 and left behind, or entered.
    const Interval<double> t = intersect(box, {{-1, 0, 1}, {1, tiny, 0}});
    EXPECT_EQ(t.empty(), tiny < 0);
  }
  // Nothing but a denormal: the box is entered beyond every number.
  expect_miss({{-1, 1, 1}, {denormal, 0, 0}});
  const Interval<double> forever = intersect(box, {{0.5, 1, 1}, {denormal, 0, 0}});
  EXPECT_EQ(forever.begin, -infinity);
  EXPECT_EQ(forever.end, infinity);
  // No direction at all.
  EXPECT_FALSE(intersect(box, {{0.5, 1, 1}, {0, 0, 0}}).empty());
  expect_miss({{1.5, 1, 1}, {0, -0.0, 0}});
}

TEST(Box, NanAndInfinityMiss) {
  for (int a = 0; a < 3; ++a) {
    for (const Vec3<double> direction : {Vec3<double>{1, 0, 0}, Vec3<double>{1, 1, 1}}) {
      Ray<double> ray{{0.5, 0.5, 0.5}, direction};
      ray.origin[a] = nan;
      expect_miss(ray);
      ray.origin[a] = infinity;
      expect_miss(ray);
      ray = {{0.5, 0.5, 0.5}, direction};
      ray.direction[a] = nan;
      expect_miss(ray);
    }
  }
}

TEST(Box, RandomRaysAgreeWithPointsOnThem) {
  // Truth: the convex function max_a |p_a(t) - centre_a| / half_a, which is at most 1 inside.
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-2, 4);
  using W = long double;
  int hits = 0;
  for (int n = 0; n < 200000; ++n) {
    const Ray<double> ray{{uniform(random), uniform(random), uniform(random)},
                          {uniform(random) - 1, uniform(random) - 1, uniform(random) - 1}};
    const auto outside = [&](W t) {
      W worst = 0;
      for (int a = 0; a < 3; ++a) {
        const W p = W(ray.origin[a]) + t * W(ray.direction[a]);
        const W centre = (W(box.lower[a]) + W(box.upper[a])) / 2;
        const W half = (W(box.upper[a]) - W(box.lower[a])) / 2;
        worst = std::max(worst, std::abs(p - centre) / half);
      }
      return worst;
    };
    const Interval<double> t = intersect(box, ray);
    if (!t.empty()) {
      ++hits;
      const W begin = W(t.begin), end = W(t.end);
      ASSERT_NEAR(static_cast<double>(outside(begin)), 1, 1e-13);
      ASSERT_NEAR(static_cast<double>(outside(end)), 1, 1e-13);
      ASSERT_LE(outside((begin + end) / 2), 1 + 1e-13L);
    } else {
      // Golden-section search for the innermost point.
      W lo = -100, hi = 100;
      for (int i = 0; i < 60; ++i) {
        const W a = lo + 0.382L * (hi - lo), b = lo + 0.618L * (hi - lo);
        (outside(a) < outside(b) ? hi : lo) = outside(a) < outside(b) ? b : a;
      }
      ASSERT_GE(outside(lo), 1 - 1e-9L);
    }
  }
  EXPECT_GT(hits, 20000);
}

}  // namespace
}  // namespace pellucid::test_box
