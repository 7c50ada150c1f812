// SPDX-License-Identifier: Apache-2.0
#include "pellucid/segment/gauss_panel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "pellucid/segment/compositor.h"
#include "tests/segment/wide_linear.h"

namespace pellucid::test_gauss_panel {
namespace {

/// Smooth extinction and color (or emission) along [0,1], with known integrals below.
Material<double> smooth(double s) {
  const double c = 0.5 + 0.5 * std::cos(7 * s);
  return {2 + 1.5 * std::sin(5 * s), {c, 1, 0}};
}

/// Composite Simpson sums in long double, 2^16 steps: below 1e-15.
std::pair<double, double> smooth_truth() {
  const int n = 1 << 16;
  const auto depth = [](long double s) { return 2 * s + 0.3L * (1 - std::cos(5 * s)); };
  long double particle = 0, independent = 0;
  for (int i = 0; i <= n; ++i) {
    const long double s = static_cast<long double>(i) / n;
    const long double weight = (i == 0 || i == n ? 1 : i % 2 == 1 ? 4 : 2) / (3.0L * n);
    const long double color = 0.5L + 0.5L * std::cos(7 * s);
    const long double light = weight * color * std::exp(-depth(s));
    independent += light;
    particle += light * (2 + 1.5L * std::sin(5 * s));
  }
  return {static_cast<double>(particle), static_cast<double>(independent)};
}

template <int N>
std::pair<double, double> march(int panels) {
  FrontToBackCompositor<double> particle, independent;
  for (int i = 0; i < panels; ++i) {
    const double d = 1.0 / panels;
    const auto at = [=](double u) { return smooth((i + u) * d); };
    particle.add(gauss_panel<N>(d, at));
    independent.add(gauss_panel_independent<N>(d, at));
  }
  return {particle.radiance().r, independent.radiance().r};
}

template <int N>
void expect_order(int panels) {
  const auto truth = smooth_truth();
  const auto coarse = march<N>(panels), fine = march<N>(2 * panels);
  const double particle =
      std::log2(std::abs(coarse.first - truth.first) / std::abs(fine.first - truth.first));
  const double independent =
      std::log2(std::abs(coarse.second - truth.second) / std::abs(fine.second - truth.second));
  std::printf("[ accuracy ] %d nodes: order %.2f, independent %.2f\n", N, particle, independent);
  EXPECT_NEAR(particle, 2 * N, 0.5) << N;
  EXPECT_NEAR(independent, 2 * N, 0.5) << N;
}

TEST(GaussPanel, OrderIsTwiceTheNodes) {
  expect_order<1>(64);
  expect_order<2>(16);
  expect_order<3>(8);
  expect_order<4>(8);
  expect_order<5>(8);
}

TEST(GaussPanel, TwelveNodesReachRounding) {
  const auto truth = smooth_truth();
  const auto result = march<12>(2);
  EXPECT_NEAR(result.first, truth.first, 2e-15);
  EXPECT_NEAR(result.second, truth.second, 2e-15);
}

template <class T>
class GaussPanelTypes : public testing::Test {};
using NumberTypes = testing::Types<float, double>;
TYPED_TEST_SUITE(GaussPanelTypes, NumberTypes);

/// Linear extinction and emission against the 60-digit integrals, within rounding.
TYPED_TEST(GaussPanelTypes, LinearSegmentToRounding) {
  using T = TypeParam;
  const double u = double(rounding_unit<T>);
  for (const auto& [f, b] : {std::pair<double, double>{0, 0.5}, {0.5, 0.25}, {1, 1}, {0, 0}}) {
    const test::WideLinear w = test::wide_linear(f, b, 2);
    const auto at = [f = f, b = b](T x) {
      return Material<T>{static_cast<T>(f) + x * static_cast<T>(b - f), {T(1) - x, x, T(1)}};
    };
    const SegmentResult<T> s = gauss_panel<10>(T(2), at);
    EXPECT_NEAR(double(s.opacity), double(w.opacity), 16 * u);
    EXPECT_NEAR(double(s.radiance.r), double(w.weight_f), 16 * u);
    EXPECT_NEAR(double(s.radiance.g), double(w.weight_b), 16 * u);
    const SegmentResult<T> e = gauss_panel_independent<10>(T(2), at);
    EXPECT_NEAR(double(e.radiance.r), 2 * double(w.emission_f), 16 * u);
    EXPECT_NEAR(double(e.radiance.g), 2 * double(w.emission_b), 16 * u);
  }
}

TYPED_TEST(GaussPanelTypes, ConstantColorAndGamut) {
  using T = TypeParam;
  const auto rough = [](T u) {
    return Material<T>{u < T(0.3) ? T(0) : T(900) * u, {u, T(0.75), u < T(0.5) ? T(1) : T(0)}};
  };
  for (const T length : {T(0), T(1e-6), T(0.01), T(1), T(1e6)}) {
    const SegmentResult<T> s = gauss_panel<6>(length, rough);
    EXPECT_NEAR(double(s.radiance.g), 0.75 * double(s.opacity),
                8 * double(rounding_unit<T>) * double(s.opacity));
    EXPECT_LE(s.radiance.r, s.opacity);
    EXPECT_GE(s.radiance.r, T(0));
    EXPECT_LE(s.radiance.b, s.opacity * (T(1) + 8 * rounding_unit<T>));
    EXPECT_TRUE(std::isfinite(gauss_panel_independent<6>(length, rough).radiance.r));
  }
}

TYPED_TEST(GaussPanelTypes, KnownDepthReplacesTheQuadratures) {
  using T = TypeParam;
  const auto at = [](T u) { return Material<T>{T(1) + u, {T(1), T(1), T(1)}}; };
  EXPECT_EQ(gauss_panel<4>(T(1), T(0.25), at).optical_depth, T(0.25));
  EXPECT_EQ(gauss_panel<4>(T(1), T(0.25), at).opacity, attenuation(T(0.25)).opacity);
  EXPECT_NEAR(double(gauss_panel<4>(T(1), at).optical_depth), 1.5, 8 * double(rounding_unit<T>));
}

TYPED_TEST(GaussPanelTypes, VacuumShinesOnlyOnItsOwn) {
  using T = TypeParam;
  const auto at = [](T) { return Material<T>{T(0), {T(1), T(2), T(3)}}; };
  EXPECT_EQ(gauss_panel<4>(T(5), at).radiance, Rgb<T>{});
  EXPECT_EQ(gauss_panel<4>(T(5), at).opacity, T(0));
  EXPECT_NEAR(double(gauss_panel_independent<4>(T(5), at).radiance.g), 10, 1e-5);
}

}  // namespace
}  // namespace pellucid::test_gauss_panel
