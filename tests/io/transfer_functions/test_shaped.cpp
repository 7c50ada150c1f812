// SPDX-License-Identifier: Apache-2.0
//
// Functions of VTK by their numbers. tests/plugins_vtk holds them against VTK itself.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pellucid/scene/error.h"
#include "src/io/transfer_functions/import_shaped.h"

namespace pellucid::imported::test_shaped {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double value_at(const Curve& curve, double x) {
  for (std::size_t i = 1; i < curve.size(); ++i) {
    if (!(x <= curve[i].x)) continue;
    const double share = (x - curve[i - 1].x) / (curve[i].x - curve[i - 1].x);
    return curve[i - 1].y.r + share * (curve[i].y.r - curve[i - 1].y.r);
  }
  return curve.back().y.r;
}

ShapedFunction opacities(std::vector<std::array<double, 2>> nodes, double largest = 1) {
  ShapedFunction made;
  for (const auto& [x, y] : nodes) made.nodes.push_back({x, {y, y, y}});
  made.largest = largest;
  return made;
}

TEST(ShapedFunction, IsExactWhereItIsStraight) {
  const FittedCurve curve = fit(opacities({{0, 0}, {2, 0.5}, {5, 0.25}}), 1e-3);
  EXPECT_EQ(curve.points, (Curve{{0, {0, 0, 0}}, {2, {0.5, 0.5, 0.5}}, {5, {0.25, 0.25, 0.25}}}));
  EXPECT_EQ(curve.deviation, 0);
}

TEST(ShapedFunction, IsZeroOutsideIfItIsNotClamped) {
  ShapedFunction function = opacities({{1, 0.5}, {2, 0.5}});
  function.is_clamped = false;
  const Curve curve = fit(function, 1e-3).points;
  EXPECT_EQ(curve.front().y.r, 0);
  EXPECT_EQ(curve[1].x, 1);
  EXPECT_EQ(curve.back().y.r, 0);
}

TEST(ShapedFunction, JumpsWhereSharpnessSaysSo) {
  for (const bool log : {false, true}) {
    ShapedFunction function = opacities({{1, 0.2}, {100, 0.8}});
    function.nodes[0].sharpness = 1;
    function.nodes[0].midpoint = 0.25;
    function.is_logarithmic = log;
    const FittedCurve curve = fit(function, 1e-3);
    const double middle = log ? std::pow(100, 0.25) : 25.75;
    EXPECT_NEAR(curve.points[1].x, middle, 1e-12 * middle);
    EXPECT_EQ(curve.points[1].x, curve.points[2].x);
    EXPECT_EQ(curve.deviation, 0);
  }
}

// Opacities of VTK 9.3.
TEST(ShapedFunction, IsACurveWhereItDoesNotJump) {
  for (const double sharpness : {0.985, 0.995, 1.0}) {
    ShapedFunction function = opacities({{0, 0.2}, {10, 0.8}});
    function.nodes[0].sharpness = sharpness;
    function.jumps = false;
    const FittedCurve curve = fit(function, 1e-4);
    EXPECT_GT(curve.deviation, 1e-5);
    EXPECT_LE(curve.deviation, 1e-4 + 1e-12);
    for (double x = 0; x < 10; x += 0.013) {
      const double p = 1 + 10 * sharpness;
      const double s = x < 5 ? 0.5 * std::pow(x / 5, p) : 1 - 0.5 * std::pow(2 - x / 5, p);
      const double shape =
          3 * s * s - 2 * s * s * s + (1 - sharpness) * (2 * s * s * s - 3 * s * s + s);
      const double truth = 0.2 + 0.6 * shape;
      const double off = std::log(std::log1p(-value_at(curve.points, x)) / std::log1p(-truth));
      EXPECT_LE(std::abs(off), curve.deviation + 1e-12) << x << " " << sharpness;
    }
  }
}

TEST(ShapedFunction, OfALogarithmIsWithinTheDeviation) {
  ShapedFunction function = opacities({{0.01, 0.1}, {1000, 0.9}});
  function.is_logarithmic = true;
  for (const double deviation : {1e-2, 1e-5}) {
    const FittedCurve curve = fit(function, deviation);
    EXPECT_GT(curve.deviation, 0.1 * deviation);
    EXPECT_LE(curve.deviation, deviation + 1e-12);
    for (double x = 0.01; x < 1000; x *= 1.003) {
      const double truth = 0.1 + 0.8 * std::log10(x / 0.01) / 5;
      const double off = std::log(std::log1p(-value_at(curve.points, x)) / std::log1p(-truth));
      EXPECT_LE(std::abs(off), curve.deviation + 1e-12) << x;
    }
  }
}

TEST(ShapedFunction, OfExtinctionsHasNoUpperLimit) {
  ShapedFunction function = opacities({{1, 0.5}, {10, 40}}, infinity);
  function.is_logarithmic = true;
  const FittedCurve curve = fit(function, 1e-4);
  for (double x = 1; x < 10; x *= 1.01) {
    const double truth = 0.5 + 39.5 * std::log10(x);
    EXPECT_LE(std::abs(std::log(value_at(curve.points, x) / truth)), curve.deviation + 1e-12);
  }
}

TEST(ShapedFunction, BegunAtZeroOnALogarithmicScaleHasNoNumber) {
  ShapedFunction function = opacities({{0, 0.1}, {10, 0.2}, {100, 0.9}});
  function.is_logarithmic = true;
  const FittedCurve curve = fit(function, 1e-4);
  EXPECT_TRUE(curve.has_no_number);
  EXPECT_NEAR(value_at(curve.points, 5), 0.15, 1e-12);
  EXPECT_NEAR(value_at(curve.points, std::sqrt(1000)), 0.55, 1e-4);
}

TEST(ShapedFunction, OfTooManyBendsIsCoarserAndSaysSo) {
  ShapedFunction function;
  function.is_color = true;
  function.space = 2;
  for (int i = 0; i < 300; ++i) {
    function.nodes.push_back(
        {i * 1.0, i % 2 == 0 ? Rgb<double>{0.9, 0.2, 0.4} : Rgb<double>{0.2, 0.7, 0.9}});
  }
  const FittedCurve curve = fit(function, 1e-9);
  EXPECT_TRUE(curve.is_coarse);
  EXPECT_GT(curve.deviation, 1e-9);
  EXPECT_LE(curve.points.size(), 200'000U);
}

TEST(ShapedFunction, WaysOfStepsCountTheLargest) {
  ShapedFunction function;
  function.is_color = true;
  function.space = 4;
  function.nodes = {{0, {0, 0, 0}}, {10, {1, 1, 1}}};
  const SampleWay way = [](const Rgb<double>&, const Rgb<double>&, int count) {
    std::vector<Rgb<double>> colors;
    for (int i = 0; i < count; ++i) {
      const double step = std::floor(7.3 * i / (count - 1.0)) / 7.3;
      colors.push_back({step, step, i == count - 1 ? 1 : step});
    }
    return colors;
  };
  const FittedCurve curve = fit(function, 1e-6, way);
  EXPECT_NEAR(curve.deviation, 1 / 7.3, 1e-3);
  for (double x = 0.05; x < 9.8; x += 0.1003) {
    const double truth = std::floor(0.73 * x) / 7.3;
    EXPECT_NEAR(value_at(curve.points, x), truth, 1e-9) << x;
  }
  EXPECT_THROW(fit(function, 1e-6), Error);
}

TEST(ShapedFunction, WithoutNodesIsZeroAndARampOfDataIsVtks) {
  EXPECT_EQ(fit(ShapedFunction(), 1e-3).points, (Curve{{0, {0, 0, 0}}}));
  EXPECT_EQ(ramp({3, 10}, false).back().y.r, 0.5);
  EXPECT_EQ(ramp({3, 10}, true).back().y.r, 1);
  EXPECT_EQ(ramp({3, 3}, true).size(), 1U);
}

}  // namespace
}  // namespace pellucid::imported::test_shaped
