// SPDX-License-Identifier: Apache-2.0
#include "pellucid/error/bounds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/support/accuracy.h"

namespace pellucid::test_bounds {
namespace {

/// κ(m) by its definition in the specification, (5), where long double holds it.
long double kappa(long double m) {
  const long double phi = -std::expm1(-m) / m;
  return (1 - phi) / (m * phi) + std::log(phi) / m;
}

TEST(MeanColorBound, IsAboveKappaByAQuarterAtMost) {
  test::ErrorRecord above("bound / kappa", "");
  // Below 1e-3 kappa's own form cancels in long double.
  for (long double m = 1e-3L; m < 1e6L; m *= 1.01L) {
    const long double bound = mean_color_bound(static_cast<double>(m));
    EXPECT_GE(bound, kappa(m) * (1 - 1e-10L)) << static_cast<double>(m);
    EXPECT_LE(bound, std::min(1.0L, m / 8) * (1 + 1e-15L));
    above.add(bound / kappa(m), "m = " + std::to_string(static_cast<double>(m)));
    EXPECT_NEAR(mean_color_bound(static_cast<float>(m)), static_cast<float>(bound), 3e-7f);
  }
  above.print();
  EXPECT_LE(above.largest(), 1.25L);
}

TEST(MeanColorBound, Edges) {
  EXPECT_EQ(mean_color_bound(0.0), 0);
  EXPECT_EQ(mean_color_bound(-0.0), 0);
  EXPECT_NEAR(mean_color_bound(1e-300), 0.125e-300, 1e-315);
  EXPECT_LE(mean_color_bound(1e300), 1);
  EXPECT_GT(mean_color_bound(1e300), 0.999);
}

/// m ε_k / (1 - e^-m) by the series of the Bessel functions (specification, 3.8).
long double panel_bound(int nodes, long double m) {
  const long double x = m / 2;
  const int k = (2 * nodes - 7) / 4;
  long double sum = 0;
  for (int j = k + 1; j < k + 60; ++j) {
    long double term = 1;
    for (int i = 1; i <= j; ++i) term *= (x / 2) / i;
    long double bessel = 0;
    for (int i = 1; i < 60; ++i) {
      bessel += term;
      term *= (x / 2) * (x / 2) / (static_cast<long double>(i) * (i + j));
    }
    sum += bessel;
  }
  return m / -std::expm1(-m) * 2 * std::exp(-x) * sum;
}

template <int N>
void expect_above_the_series() {
  test::ErrorRecord above("panel bound / series, " + std::to_string(N) + " nodes", "");
  for (double m = 1e-6; m <= 4; m *= 1.02) {
    const long double bound = panel_error_bound<N>(m), series = panel_bound(N, m);
    EXPECT_GE(bound, series * (1 - 1e-12L)) << m;
    above.add(bound / series, "m = " + std::to_string(m));
  }
  above.print();
  EXPECT_LE(above.largest(), 8);  // at m = 4
  EXPECT_LE(panel_error_bound<N>(0.5) / panel_bound(N, 0.5L), 1.7L);
  EXPECT_EQ(panel_error_bound<N>(0.0), 0);
}

TEST(PanelErrorBound, IsAboveTheSeriesItStandsFor) {
  expect_above_the_series<6>();
  expect_above_the_series<8>();
  expect_above_the_series<10>();
  expect_above_the_series<12>();
}

}  // namespace
}  // namespace pellucid::test_bounds
