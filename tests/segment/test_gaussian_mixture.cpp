// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "pellucid/segment/gaussian_panels.h"
#include "tests/segment/gaussian_rows.h"
#include "tests/segment/wide_gaussian.h"

namespace pellucid::test_gaussian_mixture {
namespace {

using test::ErrorRecord;
using test::GaussianCase;
using test::Table;

/// A row of gaussian_mixture_segment.csv, or a random mixture.
template <class T>
struct MixtureCase {
  std::vector<Gaussian<T>> primitive;
  T v1[max_channels]{}, v2[max_channels]{};
  T length{};
  GaussianMixture<T> view() const { return {primitive.data(), static_cast<int>(primitive.size())}; }

  /// Σ μ_i R_i in units of u: what rounding may do to the depth.
  long double depth_rounding() const {
    long double sum = 0;
    for (const Gaussian<T>& g : primitive) {
      GaussianCase<T> one;
      one.primitive = g;
      std::copy(v1, v1 + max_channels, one.v1);
      std::copy(v2, v2 + max_channels, one.v2);
      const auto density = static_cast<long double>(gaussian_mean_density(g, v1, v2));
      if (density > 0) {
        sum += static_cast<long double>(g.peak) * static_cast<long double>(length) * density *
               one.allowed_relative(density);
      }
    }
    return sum;
  }
};

template <class T>
MixtureCase<T> mixture_row(const Table& table, std::size_t row) {
  MixtureCase<T> result;
  const auto k = table.groups(row, "K"), c = table.groups(row, "c"),
             color = table.groups(row, "colour");
  const std::vector<double> peak = table.list(row, "tau"), v1 = table.list(row, "v1"),
                            v2 = table.list(row, "v2");
  for (std::size_t i = 0; i < k.size(); ++i) {
    Gaussian<T> g = test::gaussian_of<T>(k[i], c[i]);
    g.peak = static_cast<T>(peak[i]);
    g.color = {static_cast<T>(color[i][0]), static_cast<T>(color[i][1]),
               static_cast<T>(color[i][2])};
    result.primitive.push_back(g);
  }
  for (std::size_t i = 0; i < v1.size(); ++i) {
    result.v1[i] = static_cast<T>(v1[i]);
    result.v2[i] = static_cast<T>(v2[i]);
  }
  result.length = static_cast<T>(table.number(row, "length"));
  return result;
}

template <class T>
class Mixture : public testing::Test {};
using NumberTypes = testing::Types<float, double>;
TYPED_TEST_SUITE(Mixture, NumberTypes);

/// The table at one tolerance: opacity as stated, radiance within color_error, which is within the
/// tolerance.
template <class T>
void expect_table(double tolerance, Grade grade) {
  const Table table = Table::reference("gaussian_mixture_segment.csv");
  char name[80];
  std::snprintf(name, sizeof name, "%s %.0e %s", test::number_name<T>(), tolerance,
                grade == Grade::proved ? "proved" : "estimated");
  ErrorRecord opacity(std::string(name) + " opacity, share of the stated", ""),
      radiance(std::string(name) + " radiance", "absolute"),
      share(std::string(name) + " radiance, share of error", ""),
      reported(std::string(name) + " error, share of tolerance", "");
  int panels = 0;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const MixtureCase<T> c = mixture_row<T>(table, row);
    const std::string where = test::row_name(table, row);
    const BoundedSegment<T> s =
        integrate_gaussians(c.view(), c.v1, c.v2, c.length, static_cast<T>(tolerance), grade);
    const long double m = table.wide(row, "optical_depth"), alpha = table.wide(row, "opacity");
    const long double depth_rounding = c.depth_rounding();
    opacity.add(
        test::absolute_error_in_u(s.segment.opacity, alpha) / (std::exp(-m) * depth_rounding + 4),
        where);
    EXPECT_EQ(s.segment.optical_depth, gaussian_mixture_depth(c.view(), c.v1, c.v2, c.length));
    const long double rounding = test::unit_of<T> * alpha * (8 + (m > 0 ? depth_rounding / m : 0));
    const long double error = static_cast<long double>(s.color_error);
    const Rgb<T>& l = s.segment.radiance;
    const std::pair<T, const char*> channels[] = {
        {l.r, "radiance_r"}, {l.g, "radiance_g"}, {l.b, "radiance_b"}};
    for (const auto& [value, column] : channels) {
      const long double off = std::fabs(static_cast<long double>(value) - table.wide(row, column));
      radiance.add(off, where);
      share.add(off / (error + rounding + test::smallest_density<T>), where);
      ASSERT_GE(value, T(0)) << where;
    }
    reported.add(
        error / (static_cast<long double>(tolerance) * static_cast<long double>(s.segment.opacity) +
                 1e-300L),
        where);
    panels += s.panels;
    EXPECT_TRUE(s.proved || grade == Grade::estimated) << where;
  }
  opacity.print();
  radiance.print();
  share.print();
  reported.print();
  EXPECT_EQ(opacity.count(), 400u);
  EXPECT_LE(opacity.largest(), 1);
  EXPECT_LE(share.largest(), 1);
  EXPECT_LE(reported.largest(), 1.0001L);
  EXPECT_GT(panels, 40);
}

TYPED_TEST(Mixture, TruthTable) {
  using T = TypeParam;
  expect_table<T>(1e-3, Grade::estimated);
  expect_table<T>(1e-5, Grade::estimated);
  if constexpr (!is_single<T>) {
    expect_table<T>(1e-6, Grade::estimated);
    expect_table<T>(1e-9, Grade::estimated);
    expect_table<T>(1e-12, Grade::estimated);
  }
}

TYPED_TEST(Mixture, TruthTableProved) {
  expect_table<TypeParam>(1e-2, Grade::proved);
  expect_table<TypeParam>(1e-3, Grade::proved);
  if constexpr (!is_single<TypeParam>) expect_table<TypeParam>(1e-5, Grade::proved);
}

/// The mean color and its bound (5), on the table; and that it is Kniss's for one color.
TYPED_TEST(Mixture, MeanColorIsWithinItsBound) {
  using T = TypeParam;
  const Table table = Table::reference("gaussian_mixture_segment.csv");
  ErrorRecord share(std::string(test::number_name<T>()) + " mean color, share of bound", ""),
      error(std::string(test::number_name<T>()) + " mean color", "absolute");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    MixtureCase<T> c = mixture_row<T>(table, row);
    const BoundedSegment<T> s = gaussian_mixture_mean(c.view(), c.v1, c.v2, c.length);
    const long double m = table.wide(row, "optical_depth"), alpha = table.wide(row, "opacity");
    const long double rounding =
        test::unit_of<T> * alpha * (8 + (m > 0 ? c.depth_rounding() / m : 0));
    const long double off =
        std::fabs(static_cast<long double>(s.segment.radiance.g) - table.wide(row, "radiance_g"));
    error.add(off, test::row_name(table, row));
    share.add(
        off / (static_cast<long double>(s.color_error) + rounding + test::smallest_density<T>),
        test::row_name(table, row));
    EXPECT_TRUE(s.proved);
    for (Gaussian<T>& g : c.primitive) g.color = {T(0.25), T(0.5), T(1)};
    const BoundedSegment<T> one = gaussian_mixture_mean(c.view(), c.v1, c.v2, c.length);
    EXPECT_EQ(one.color_error, T(0));
    EXPECT_EQ(one.segment.radiance.b, one.segment.opacity);
  }
  error.print();
  share.print();
  EXPECT_LE(share.largest(), 1);
  EXPECT_GT(share.largest(), 0.5L) << "the bound is nearly reached on the table";
}

/// Parts of a line against the defining integral, through a primitive of the part's own ends.
TYPED_TEST(Mixture, PartsOfALine) {
  using T = TypeParam;
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> unit(0, 1);
  test::DensityErrors<T> errors(std::string(test::number_name<T>()) + " line");
  for (int i = 0; i < 300; ++i) {
    // x = a + u length in one channel, the distance from the line in another: exact numbers.
    const double scale = std::ldexp(1.0, static_cast<int>(8 * unit(random)) - 3);
    const double a = std::round(64 * (2 * unit(random) - 1)) / 64 * scale,
                 d = std::round(1 + 255 * unit(random)) / 64 * scale,
                 w = std::round(32 * unit(random)) / 16;
    const T p1[2] = {static_cast<T>(a), static_cast<T>(w)};
    const T p2[2] = {static_cast<T>(a + d), static_cast<T>(w)};
    const T step[2] = {static_cast<T>(d), T(0)};
    const GaussianLine<T> line(p1, p2, step, 2);
    const double from = std::round(32 * unit(random)) / 64;
    const double to = i % 3 == 0 ? 1 : from + 1.0 / (i % 3 == 1 ? 8 : 64);
    GaussianCase<T> g;
    g.primitive.channels = g.primitive.rows = 2;
    g.primitive.matrix[0][0] = g.primitive.matrix[1][1] = T(1);
    g.v1[0] = static_cast<T>(a + from * d);
    g.v2[0] = static_cast<T>(a + to * d);
    g.v1[1] = g.v2[1] = static_cast<T>(w);
    errors.add(line.mean_density(static_cast<T>(from), static_cast<T>(to)),
               static_cast<long double>(test::wide_mean_density(g.primitive, g.v1, g.v2)), g,
               [&] { return std::to_string(i); });
  }
  errors.expect_stated();
}

/// The green radiance of a mixture over one channel: depths by the library's erf, the integral by
/// Gauß-Legendre on 64 panels, in long double.
long double truth_in_one_channel(const MixtureCase<double>& c) {
  using Number = long double;
  static const boost::math::quadrature::gauss<Number, 20> rule;
  const auto wide = [](double x) { return static_cast<Number>(x); };
  const Number v1 = wide(c.v1[0]), step = wide(c.v2[0]) - v1, length = wide(c.length);
  const auto light = [&](Number u) {
    Number depth = 0, emission = 0;
    for (const Gaussian<double>& g : c.primitive) {
      const Number k = wide(g.matrix[0][0]), peak = wide(g.peak);
      const Number z0 = k * (v1 - wide(g.center[0])), z = z0 + k * step * u;
      depth += peak * length * std::sqrt(std::acos(-1.0L)) / (2 * k * step) *
               (std::erf(z) - std::erf(z0));
      emission += peak * std::exp(-z * z) * wide(g.color.g);
    }
    return length * emission * std::exp(-depth);
  };
  Number sum = 0;
  for (int i = 0; i < 64; ++i) {
    const Number half = Number(1) / 128, middle = (2 * i + 1) * half;
    for (std::size_t j = 0; j < rule.abscissa().size(); ++j) {
      const Number x = half * rule.abscissa()[j];
      sum += half * rule.weights()[j] * (light(middle - x) + light(middle + x));
    }
  }
  return sum;
}

/// Random mixtures of two to eight narrow primitives, against quadrature in long double.
TEST(MixtureRandom, RadianceIsWithinTheReportedError) {
  using T = double;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
    for (const Grade grade : {Grade::estimated, Grade::proved}) {
      if (grade == Grade::proved && tolerance < 1e-5) continue;
      ErrorRecord share("random mixtures, share of error", "");
      for (int i = 0; i < 150; ++i) {
        MixtureCase<T> c;
        const int count = 2 + static_cast<int>(6 * unit(random));
        for (int k = 0; k < count; ++k) {
          Gaussian<T> g;
          g.matrix[0][0] = std::pow(10.0, 1.8 * unit(random));
          g.center[0] = 1.2 * unit(random) - 0.1;
          g.peak = std::pow(10.0, -1 + 3 * unit(random));
          g.color = {unit(random), unit(random) < 0.5 ? 0.0 : 1.0, unit(random)};
          c.primitive.push_back(g);
        }
        c.v1[0] = unit(random);
        c.v2[0] = unit(random);
        if (std::fabs(c.v2[0] - c.v1[0]) < 0.02) continue;
        c.length = unit(random);
        const long double truth = truth_in_one_channel(c);
        const BoundedSegment<T> s =
            integrate_gaussians(c.view(), c.v1, c.v2, c.length, tolerance, grade);
        const long double off = std::fabs(static_cast<long double>(s.segment.radiance.g) - truth);
        share.add(off / (static_cast<long double>(s.color_error) + 1e-13L),
                  [&] { return std::to_string(i); });
        ASSERT_LE(s.color_error, tolerance * s.segment.opacity * 1.0001);
      }
      share.print();
      EXPECT_LE(share.largest(), 1) << tolerance;
    }
  }
}

/// Two primitives with colors 0 and 1 on one panel, and the panel's largest exponent change and
/// depth.
struct TwoOnAPanel {
  double numbers[6];  ///< a, length, ln peak of both
  SegmentResult<double> panel(int nodes) const {
    const auto at = [&](double u) {
      double density[2];
      for (int i = 0; i < 2; ++i) {
        const double x = numbers[3 * i] + u * numbers[3 * i + 1];
        density[i] = std::exp(numbers[3 * i + 2] - x * x);
      }
      const double sum = density[0] + density[1];
      return Material<double>{sum, {density[1] / sum, 0, 0}};
    };
    if (nodes == 4) return gauss_panel<4>(1.0, depth(), at);
    if (nodes == 6) return gauss_panel<6>(1.0, depth(), at);
    if (nodes == 8) return gauss_panel<8>(1.0, depth(), at);
    if (nodes == 10) return gauss_panel<10>(1.0, depth(), at);
    // The truth: sixteen panels of twelve nodes.
    SegmentResult<double> sum;
    for (int i = 0; i < 16; ++i) {
      sum = compose(sum, gauss_panel<12>(1.0 / 16, [&](double u) { return at((i + u) / 16); }));
    }
    return sum;
  }
  double depth() const {
    double sum = 0;
    for (int i = 0; i < 2; ++i) {
      const double p1 = numbers[3 * i], d = numbers[3 * i + 1], p2 = p1 + d;
      sum += std::exp(numbers[3 * i + 2]) * gaussian_mean_density(&p1, &p2, &d, 1);
    }
    return sum;
  }
  double exponents() const {
    double largest = 0;
    for (int i = 0; i < 2; ++i) {
      const double a = numbers[3 * i], d = numbers[3 * i + 1];
      largest = std::max(largest, d * d + std::fabs(d * (2 * a + d)));
    }
    return largest;
  }
  double error(int nodes) const {
    const SegmentResult<double> truth = panel(16), it = panel(nodes);
    return std::fabs(it.radiance.r - truth.radiance.r) / truth.opacity;
  }
};

/// The estimate of a panel against random ones, each improved by hill climbing: what was found
/// stays below half of the estimate.
TEST(GaussianPanelEstimate, HoldsUnderHillClimbing) {
  const double limits[4][2] = {{1, 0.5}, {2, 1}, {4, 1}, {4, 4}};
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> normal;
  for (const double* limit : {limits[0], limits[1], limits[2], limits[3]}) {
    const double r = limit[0], m = limit[1];
    for (const int nodes : {4, 6, 8, 10}) {
      const double estimate = nodes == 4   ? gaussian_panel_estimate<4>(r, m)
                              : nodes == 6 ? gaussian_panel_estimate<6>(r, m)
                              : nodes == 8 ? gaussian_panel_estimate<8>(r, m)
                                           : gaussian_panel_estimate<10>(r, m);
      double worst = 0;
      for (int start = 0; start < 60; ++start) {
        // Inside the limits: scaled back to them.
        const auto legal = [&](TwoOnAPanel p) {
          for (int i = 0; i < 2; ++i) {
            double &a = p.numbers[3 * i], &d = p.numbers[3 * i + 1];
            const double now = d * d + std::fabs(d * (2 * a + d));
            if (now > r) d *= r / now;
          }
          const double scale = std::log(std::min(1.0, m / p.depth()));
          p.numbers[2] += scale;
          p.numbers[5] += scale;
          return p;
        };
        TwoOnAPanel best{{3 * normal(random), normal(random), normal(random) + 1,
                          3 * normal(random), normal(random), normal(random) + 1}};
        for (int i = 0; i < 2; ++i) {
          best.numbers[3 * i + 2] += best.numbers[3 * i] * best.numbers[3 * i];
        }
        best = legal(best);
        double found = best.error(nodes);
        double step = 0.5;
        for (int i = 0; i < 150; ++i) {
          TwoOnAPanel next = best;
          for (double& x : next.numbers) x += step * normal(random) * (unit(random) < 0.5);
          next = legal(next);
          const double error = next.error(nodes);
          if (error > found && next.exponents() <= r * 1.0001) {
            best = next;
            found = error;
          } else {
            step = std::max(0.97 * step, 1e-3);
          }
        }
        worst = std::max(worst, found);
      }
      std::printf("[ accuracy ] panel of %2d nodes, r <= %g, m <= %g: found %.2g, estimate %.2g\n",
                  nodes, r, m, worst, estimate);
      EXPECT_LE(worst, 0.5 * estimate + 2e-14) << nodes << ' ' << r << ' ' << m;
    }
  }
}

/// Hard numbers: finite, in gamut, and the work ends.
TYPED_TEST(Mixture, EdgesAreFiniteAndInGamut) {
  using T = TypeParam;
  const T big = is_single<T> ? T(1e9) : T(1e70);
  const T numbers[] = {T(0), T(1e-30), T(-1), T(3), big};
  for (const T width : {T(1e-6), T(1), T(1e4), big}) {
    for (const T peak : {T(0), T(1e-30), T(1), T(1e6)}) {
      for (const T x1 : numbers) {
        for (const T x2 : numbers) {
          std::vector<Gaussian<T>> two(2);
          for (std::size_t i = 0; i < 2; ++i) {
            two[i].matrix[0][0] = width;
            two[i].center[0] = static_cast<T>(i);
            two[i].peak = peak;
            two[i].color = {i == 0 ? T(1) : T(0), T(1), T(0)};
          }
          for (const Grade grade : {Grade::estimated, Grade::proved}) {
            const BoundedSegment<T> s =
                integrate_gaussians(GaussianMixture<T>{two.data(), 2}, &x1, &x2, T(10),
                                    grade == Grade::proved ? T(0.01) : T(1e-5), grade);
            SCOPED_TRACE(testing::Message() << width << ", " << peak << ": " << x1 << " " << x2);
            ASSERT_TRUE(std::isfinite(s.segment.radiance.r) && std::isfinite(s.color_error));
            ASSERT_GE(s.segment.radiance.r, T(0));
            ASSERT_LE(s.segment.radiance.r, s.segment.opacity * (T(1) + 16 * rounding_unit<T>));
          }
        }
      }
    }
  }
}

/// More primitives than a segment is cut for: the mean color, and an error that says so.
TEST(MixtureMany, TooManyGiveTheMeanColorAndItsBound) {
  std::vector<Gaussian<double>> many(max_primitives + 1);
  for (std::size_t i = 0; i < many.size(); ++i) {
    many[i].matrix[0][0] = 30;
    many[i].center[0] = static_cast<double>(i) / static_cast<double>(many.size());
    many[i].peak = 4;
    many[i].color = {i % 2 == 0 ? 1.0 : 0.0, static_cast<double>(i < 32), 0};
  }
  const double v1 = 0, v2 = 1;
  const auto at = [&](int count) {
    return integrate_gaussians(GaussianMixture<double>{many.data(), count}, &v1, &v2, 1.0, 1e-4,
                               Grade::estimated);
  };
  EXPECT_TRUE(at(max_primitives).panels);
  EXPECT_LE(at(max_primitives).color_error, 1e-4);
  const BoundedSegment<double> s = at(max_primitives + 1);
  EXPECT_FALSE(s.panels);
  EXPECT_GT(s.color_error, 0.01);
  EXPECT_LE(std::fabs(s.segment.radiance.g - at(max_primitives).segment.radiance.g),
            s.color_error + 0.01);
}

}  // namespace
}  // namespace pellucid::test_gaussian_mixture
