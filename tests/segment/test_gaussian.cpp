// SPDX-License-Identifier: Apache-2.0
#include "pellucid/segment/gaussian.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "pellucid/segment/gaussian_kniss.h"
#include "tests/segment/gaussian_rows.h"
#include "tests/segment/wide_gaussian.h"

namespace pellucid::test_gaussian {
namespace {

using test::DensityErrors;
using test::ErrorRecord;
using test::GaussianCase;
using test::Table;

template <class T>
class GaussianSegment : public testing::Test {};
using NumberTypes = testing::Types<float, double>;
TYPED_TEST_SUITE(GaussianSegment, NumberTypes);

TYPED_TEST(GaussianSegment, TruthTable) {
  using T = TypeParam;
  const Table table = Table::reference("gaussian_segment.csv");
  const std::string name = test::number_name<T>();
  DensityErrors<T> density(name);
  ErrorRecord opacity(name + " opacity, share of m e^-m R + 4 u", "");
  int bounded = 0;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const GaussianCase<T> g = test::gaussian_row<T>(table, row);
    const std::string where = test::row_name(table, row);
    const long double truth = table.wide(row, "mean_density");
    const T mean = gaussian_mean_density(g.primitive, g.v1, g.v2);
    density.add(mean, truth, g, where);
    // Never denser than the peak; reversed, the same within the errors of both.
    density.add(gaussian_mean_density(g.primitive, g.v2, g.v1), truth, g, where + ", reversed");
    const SegmentResult<T> segment =
        gaussian_segment(g.primitive, g.v1, g.v2, static_cast<T>(table.number(row, "length")));
    const long double m = table.wide(row, "optical_depth");
    const long double allowed = (truth > 0 ? m * std::exp(-m) * g.allowed_relative(truth) : 0) + 4;
    opacity.add(test::absolute_error_in_u(segment.opacity, table.wide(row, "opacity")) / allowed,
                where);
    EXPECT_EQ(segment.radiance.r, segment.opacity) << where;
    EXPECT_EQ(segment.radiance.b, T(0)) << where;
    if (truth >= test::smallest_density<T>) {
      ++bounded;
      EXPECT_GE(gaussian_rounding(g.primitive, g.v1, g.v2, mean),
                static_cast<T>(0.99L * g.allowed_relative(truth) * test::unit_of<T>))
          << where;
    }
  }
  opacity.print();
  density.expect_stated();
  EXPECT_LE(opacity.largest(), 1);
  EXPECT_EQ(opacity.count(), 1000u);
  EXPECT_GT(bounded, 600);
}

/// Random primitives of any rank and shape, segments from points to a million widths, both sides of
/// every seam between the regimes, against the defining integral.
TYPED_TEST(GaussianSegment, RandomSegmentsAgainstQuadrature) {
  using T = TypeParam;
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> normal;
  DensityErrors<T> errors(std::string(test::number_name<T>()) + " random");
  for (int i = 0; i < 400; ++i) {
    GaussianCase<T> g;
    const int n = 1 + static_cast<int>(8 * unit(random)) % 8;
    g.primitive.channels = n;
    g.primitive.rows = 1 + static_cast<int>(n * unit(random)) % n;
    const double steep = std::pow(10.0, 3 * unit(random));
    for (int r = 0; r < g.primitive.rows; ++r) {
      for (int k = 0; k < n; ++k) {
        g.primitive.matrix[r][k] = static_cast<T>(steep * normal(random));
      }
    }
    // Lengths |d| and distances from the center in widths; the seams are at |d| = √2 and h = 1.
    const double length = i % 4 == 0   ? std::sqrt(2.0) * (1 + 1e-3 * normal(random))
                          : i % 4 == 1 ? std::pow(10.0, -6 + 6 * unit(random))
                          : i % 4 == 2 ? std::pow(10.0, 2.5 * unit(random))
                                       : 3 * unit(random);
    const double distance = i % 3 == 0 ? 0.3 * unit(random) : i % 3 == 1 ? 2.0 : 8.0;
    for (int k = 0; k < n; ++k) {
      g.primitive.center[k] = static_cast<T>(unit(random));
      const double from = distance * normal(random) / steep / n;
      const double by = length * normal(random) / steep / n;
      g.v1[k] = static_cast<T>(static_cast<double>(g.primitive.center[k]) + from);
      g.v2[k] = static_cast<T>(static_cast<double>(g.v1[k]) + by);
    }
    errors.add(gaussian_mean_density(g.primitive, g.v1, g.v2),
               static_cast<long double>(test::wide_mean_density(g.primitive, g.v1, g.v2)), g,
               [&] { return "case " + std::to_string(i); });
  }
  errors.expect_stated();
  EXPECT_GT(errors.relative.count(), 200u);
}

/// One channel, width 1: the seams between the regimes from close by, and far tails.
TYPED_TEST(GaussianSegment, SeamsAndTailsOfOneChannel) {
  using T = TypeParam;
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  DensityErrors<T> errors(std::string(test::number_name<T>()) + " one channel");
  const double far = is_single<T> ? 8 : 25;
  for (int i = 0; i < 400; ++i) {
    GaussianCase<T> g;
    g.primitive.matrix[0][0] = T(1);
    const double tiny = std::pow(10.0, -9 * unit(random)) * (unit(random) < 0.5 ? -1 : 1);
    const double a = i % 5 == 0 ? tiny : i % 5 == 1 ? 1 + tiny : far * (2 * unit(random) - 1);
    const double step = i % 3 == 0   ? std::sqrt(2.0) * (1 + tiny)
                        : i % 3 == 1 ? 20 * (2 * unit(random) - 1)
                                     : 2 / (std::fabs(a) + 1e-9) * (1 + tiny) / 2;
    g.v1[0] = static_cast<T>(a);
    g.v2[0] = static_cast<T>(a + step);
    errors.add(gaussian_mean_density(g.primitive, g.v1, g.v2),
               static_cast<long double>(test::wide_mean_density(g.primitive, g.v1, g.v2)), g,
               [&] { return std::to_string(a) + " + " + std::to_string(step); });
  }
  errors.expect_stated();
}

/// Every combination of hard numbers: nothing is NaN, infinite or out of [0, 1].
TYPED_TEST(GaussianSegment, EdgesAreFiniteAndInBounds) {
  using T = TypeParam;
  using Limits = std::numeric_limits<T>;
  const T half_exponent = is_single<T> ? T(1e18) : T(1e150);
  const T widths[] = {T(0),   Limits::denorm_min(), Limits::min(), T(1e-6), T(1),
                      T(1e6), half_exponent};
  const T values[] = {T(0),           Limits::denorm_min(),
                      -Limits::min(), T(1e-6),
                      T(-1),          T(1),
                      T(1.41),        T(2),
                      T(-9),          T(30),
                      T(1e6),         -half_exponent};
  Gaussian<T> g;
  g.channels = g.rows = 2;
  g.peak = T(3);
  for (const T k0 : widths) {
    for (const T k1 : widths) {
      g.matrix[0][0] = k0;
      g.matrix[1][1] = k1;
      for (const T x1 : values) {
        for (const T y1 : values) {
          for (const T x2 : values) {
            for (const T y2 : values) {
              const T v1[2] = {x1, y1}, v2[2] = {x2, y2};
              const T mean = gaussian_mean_density(g, v1, v2);
              ASSERT_TRUE(mean >= T(0) && mean <= T(1))
                  << k0 << ' ' << k1 << ": " << x1 << ", " << y1 << " -> " << x2 << ", " << y2;
              const T kniss = kniss_mean_density(g, v1, v2);
              ASSERT_TRUE(kniss >= T(0) && kniss <= T(1));
              if (k0 == T(0) && k1 == T(0)) {
                ASSERT_EQ(mean, T(1));
              }
            }
          }
        }
      }
    }
  }
}

TYPED_TEST(GaussianSegment, PointsHaveTheirDensityAndVacuumNone) {
  using T = TypeParam;
  Gaussian<T> g = test::gaussian_of<T>({3, 1, 0, 2}, {0.5, 0.25});
  g.peak = T(7);
  g.color = {T(1), T(2), T(3)};
  for (double x = -2; x <= 2; x += 0.125) {
    const T v[2] = {static_cast<T>(x), T(0.125)};
    EXPECT_NEAR(gaussian_mean_density(g, v, v), g.density(v), 4 * rounding_unit<T>);
    const SegmentResult<T> none = gaussian_segment(g, v, v, T(0));
    EXPECT_EQ(none.opacity, T(0));
    EXPECT_EQ(none.radiance, Rgb<T>{});
    const GaussianMixture<T> mixture{&g, 1};
    const Material<T> m = mixture.evaluate(v);
    EXPECT_NEAR(m.extinction, T(7) * g.density(v), 8 * rounding_unit<T>);
    if (m.extinction > T(1e-30)) {
      EXPECT_NEAR(m.color.g, 2, 8 * rounding_unit<T>);
    }
  }
}

/// The stated 2.5e-5 of erf (25), and what it makes of the rows: not asserted to be good, but to be
/// what is said of it.
TYPED_TEST(GaussianSegment, ErrorOfKniss) {
  using T = TypeParam;
  double worst = 0;
  for (double x = -6; x <= 6; x += 1.0 / 512) {
    worst = std::max(worst, std::fabs(static_cast<double>(erf_kniss(static_cast<T>(x))) -
                                      std::erf(static_cast<double>(static_cast<T>(x)))));
  }
  std::printf("[ accuracy ] %s erf_kniss: largest absolute error %.3g\n", test::number_name<T>(),
              worst);
  EXPECT_LE(worst, 2.5e-5);
  EXPECT_GE(worst, 2e-5);
  EXPECT_EQ(erf_kniss(T(100)), T(1));
  const Table table = Table::reference("gaussian_segment.csv");
  ErrorRecord error(std::string(test::number_name<T>()) + " Kniss (12) with (25)", "absolute");
  ErrorRecord relative(std::string(test::number_name<T>()) + " Kniss, |d| > 0.1, rho > 0.01",
                       "relative");
  int above = 0, own_above = 0;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const GaussianCase<T> g = test::gaussian_row<T>(table, row);
    const long double truth = table.wide(row, "mean_density");
    const auto off = [&](T value) { return std::fabs(static_cast<long double>(value) - truth); };
    const long double kniss = off(kniss_mean_density(g.primitive, g.v1, g.v2));
    error.add(kniss, test::row_name(table, row));
    above += kniss > 0.01L * truth && truth > 1e-30L;
    own_above +=
        off(gaussian_mean_density(g.primitive, g.v1, g.v2)) > 0.01L * truth && truth > 1e-30L;
    T d[max_channels];
    g.primitive.displacement(g.v1, g.v2, d);
    const detail::Direction<T> direction(d, g.primitive.rows);
    if (direction.length > T(0.1) && truth > 0.01L) {
      relative.add(kniss / truth, test::row_name(table, row));
    }
  }
  error.print();
  relative.print();
  std::printf("[ accuracy ] rows more than 1 %% off: Kniss %d, here %d\n", above, own_above);
  EXPECT_GT(error.largest(), 1e-5L);
}

}  // namespace
}  // namespace pellucid::test_gaussian
