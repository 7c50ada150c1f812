// SPDX-License-Identifier: Apache-2.0
#include "pellucid/segment/classical.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "pellucid/segment/compositor.h"
#include "pellucid/segment/gauss_panel.h"
#include "pellucid/segment/linear.h"

namespace pellucid::test_classical {
namespace {

/// The example of the specification, 3.1: extinction 3 + 40 exp(-64 (s - 0.4)²), color
/// ½ + ½ sin 9s, length 1.
Material<double> example(double s) {
  const double extinction = 3 + 40 * std::exp(-64 * (s - 0.4) * (s - 0.4));
  const double color = 0.5 + 0.5 * std::sin(9 * s);
  return {extinction, {color, color, color}};
}

/// Independent of the kernels: midpoint sums with 2^20 steps, Richardson-extrapolated; the error is
/// below 1e-12 (the two finest extrapolations agree to that).
struct Truth {
  double depth, radiance;
};
Truth example_truth() {
  const auto sums = [](int n) {
    long double depth = 0, radiance = 0;
    for (int i = 0; i < n; ++i) {
      const long double s = (i + 0.5L) / n;
      const long double extinction = 3 + 40 * std::exp(-64 * (s - 0.4L) * (s - 0.4L));
      const long double color = 0.5L + 0.5L * std::sin(9 * s);
      const long double x = extinction / n;
      radiance += color * std::exp(-depth - x / 2) * x;
      depth += x;
    }
    return std::pair<long double, long double>(depth, radiance);
  };
  const auto a = sums(1 << 15), b = sums(1 << 16);
  return {static_cast<double>((4 * b.first - a.first) / 3),
          static_cast<double>((4 * b.second - a.second) / 3)};
}

using Step = std::function<SegmentResult<double>(double s, double length)>;

SegmentResult<double> march(const Step& step, int n) {
  FrontToBackCompositor<double> fold;
  for (int i = 0; i < n; ++i) fold.add(step(static_cast<double>(i) / n, 1.0 / n));
  return fold.result();
}

struct Rule {
  std::string name;
  Step step;
  double printed[3];  ///< errors of the radiance for n = 8, 32, 128 in the specification
  int order, opacity_order;
};

const std::vector<Rule>& rules() {
  const auto front = [](double s, double) { return example(s); };
  const auto back = [](double s, double d) { return example(s + d); };
  const auto middle = [](double s, double d) { return example(s + d / 2); };
  static const std::vector<Rule> all = {
      {"taylor",
       [=](double s, double d) { return taylor_segment(front(s, d), d); },
       {1.3e-1, 3.3e-3, 1.3e-3},
       1,
       1},
      {"rectangle",
       [=](double s, double d) { return rectangle_segment(front(s, d), d); },
       {8.1e-2, 1.7e-2, 3.8e-3},
       1,
       1},
      {"midpoint",
       [=](double s, double d) { return midpoint_segment(middle(s, d), d); },
       {1.6e-2, 6.4e-4, 4.0e-5},
       2,
       2},
      {"average",
       [=](double s, double d) { return average_segment(front(s, d), back(s, d), d); },
       {3.3e-2, 1.7e-3, 1.0e-4},
       2,
       2},
      {"trapezoid",
       [=](double s, double d) { return trapezoid_segment(front(s, d), back(s, d), d); },
       {3.3e-2, 1.7e-3, 1.0e-4},
       2,
       2},
      {"linear",
       [=](double s, double d) {
         const Material<double> f = front(s, d), b = back(s, d);
         return linear_segment(f.extinction, b.extinction, f.color, b.color, d);
       },
       {1.8e-2, 7.0e-4, 4.2e-5},
       2,
       2},
      {"simpson",
       [=](double s, double d) {
         return simpson_segment(front(s, d), middle(s, d), back(s, d), d);
       },
       {3.7e-2, 2.4e-3, 1.5e-4},
       2,
       4},
      {"gauss panel, 4 nodes",
       [=](double s, double d) {
         return gauss_panel<4>(d, [=](double u) { return example(s + u * d); });
       },
       {2.2e-5, 6.0e-11, 6.7e-16},
       8,
       8},
  };
  return all;
}

/// The table of section 3.1, to the two digits it prints.
TEST(Classical, TableOfTheSpecification) {
  const Truth truth = example_truth();
  for (const Rule& rule : rules()) {
    for (int k = 0; k < 3; ++k) {
      const double error = std::abs(march(rule.step, 8 << (2 * k)).radiance.r - truth.radiance);
      std::printf("[ accuracy ] %-22s n = %3d   error %.2e   printed %.1e\n", rule.name.c_str(),
                  8 << (2 * k), error, rule.printed[k]);
      // Below 1e-11 the last digits are those of rounding.
      if (rule.printed[k] < 1e-11) {
        EXPECT_LE(error, 1e-13) << rule.name;
      } else {
        EXPECT_NEAR(error / rule.printed[k], 1, 0.06) << rule.name << ", n = " << (8 << (2 * k));
      }
    }
  }
}

/// Fitted over doublings far enough into the asymptotic range and above rounding.
TEST(Classical, OrdersOfConvergence) {
  const Truth truth = example_truth();
  const double opacity = -std::expm1(-truth.depth);
  for (const Rule& rule : rules()) {
    const int n = rule.order == 8 ? 16 : 512;
    const auto error = [&](int steps) {
      return std::abs(march(rule.step, steps).radiance.r - truth.radiance);
    };
    const double order = std::log2(error(n) / error(2 * n));
    EXPECT_NEAR(order, rule.order, rule.order == 8 ? 1 : 0.1) << rule.name;
    // The opacity's own order shows in the optical depth.
    if (rule.opacity_order == 4) {
      const double o = std::log2(std::abs(march(rule.step, 32).optical_depth - truth.depth) /
                                 std::abs(march(rule.step, 64).optical_depth - truth.depth));
      EXPECT_NEAR(o, 4, 0.3) << rule.name;
    }
  }
  EXPECT_GT(opacity, 0.99999);
}

template <class T>
class ClassicalRules : public testing::Test {};
using NumberTypes = testing::Types<float, double>;
TYPED_TEST_SUITE(ClassicalRules, NumberTypes);

/// On a constant medium all but Taylor's are exact.
TYPED_TEST(ClassicalRules, AreExactOnConstantMedia) {
  using T = TypeParam;
  const double u = double(rounding_unit<T>);
  for (double depth = 1e-8; depth < 1e3; depth *= 3) {
    const Material<T> m{static_cast<T>(depth / 2), {T(0.5), T(2), T(0)}};
    const double opacity = -std::expm1(-double(m.extinction) * 2);
    for (const SegmentResult<T>& s :
         {rectangle_segment(m, T(2)), midpoint_segment(m, T(2)), average_segment(m, m, T(2)),
          trapezoid_segment(m, m, T(2)), simpson_segment(m, m, m, T(2))}) {
      EXPECT_NEAR(double(s.opacity) / opacity, 1, 8 * u);
      EXPECT_NEAR(double(s.radiance.g) / (2 * opacity), 1, 16 * u);
      EXPECT_EQ(s.radiance.b, T(0));
    }
  }
}

TYPED_TEST(ClassicalRules, TaylorClampsOpacityButNotRadiance) {
  using T = TypeParam;
  const Material<T> m{T(2), {T(1), T(1), T(1)}};
  const SegmentResult<T> thin = taylor_segment(m, T(0.25));
  EXPECT_EQ(thin.opacity, T(0.5));
  EXPECT_EQ(thin.transparency, T(0.5));
  EXPECT_EQ(thin.radiance.r, T(0.5));
  EXPECT_NEAR(double(thin.optical_depth), std::log(2.0), 1e-6);
  const SegmentResult<T> thick = taylor_segment(m, T(3));
  EXPECT_EQ(thick.opacity, T(1));
  EXPECT_EQ(thick.transparency, T(0));
  EXPECT_EQ(thick.radiance.r, T(6));
  EXPECT_TRUE(std::isinf(thick.optical_depth));
}

TYPED_TEST(ClassicalRules, VacuumGivesNothing) {
  using T = TypeParam;
  const Material<T> m{T(0), {T(1), T(1), T(1)}};
  for (const SegmentResult<T>& s :
       {rectangle_segment(m, T(2)), taylor_segment(m, T(2)), midpoint_segment(m, T(2)),
        trapezoid_segment(m, m, T(2)), simpson_segment(m, m, m, T(2))}) {
    EXPECT_EQ(s.opacity, T(0));
    EXPECT_EQ(s.transparency, T(1));
    EXPECT_EQ(s.radiance, Rgb<T>{});
  }
}

/// Simpson's color is weighted by the extinction; huge extinctions and colors do not overflow.
TYPED_TEST(ClassicalRules, SimpsonWeightsColorByExtinction) {
  using T = TypeParam;
  const Material<T> black{T(0), {T(1), T(0), T(0)}}, green{T(1), {T(0), T(1), T(0)}};
  const SegmentResult<T> s = simpson_segment(black, green, black, T(1));
  EXPECT_EQ(s.radiance.r, T(0));
  EXPECT_EQ(s.radiance.g, s.opacity);
  const T huge = std::numeric_limits<T>::max() / T(8);
  const Material<T> dense{huge, {huge, huge, huge}};
  const SegmentResult<T> d = simpson_segment(dense, dense, dense, T(1));
  EXPECT_TRUE(std::isfinite(d.radiance.r));
  EXPECT_EQ(d.opacity, T(1));
}

}  // namespace
}  // namespace pellucid::test_classical
