// SPDX-License-Identifier: Apache-2.0
#include "pellucid/segment/multivariate_panel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/segment/multivariate_case.h"
#include "tests/support/accuracy.h"

namespace pellucid::test_multivariate_panel {
namespace {

using test::ErrorRecord;
using test::Maker;
using test::MultivariateCase;

/// What the truth itself and its comparison are good for.
constexpr long double slack = 1e-14L;

PanelDemand<double> demand_of(const MultivariateCase& at, Grade grade, bool last_resort) {
  PanelDemand<double> demand;
  demand.grade = grade;
  demand.largest_color = at.largest_color;
  demand.last_resort = last_resort;
  return demand;
}

/// Of straight panels the data are cubics for the truth alone.
enum class Data { cubic, linear };

LinearSpan<double> linear_span(const MultivariateCase& at) {
  LinearSpan<double> span;
  span.length = at.span.length;
  for (int c = 0; c < at.channels; ++c)
    span.data[c] = {{at.span.data[c].b[0], at.span.data[c].b[3]}};
  return span;
}
void straighten(MultivariateCase& at) {
  const LinearSpan<double> span = linear_span(at);
  for (int c = 0; c < at.channels; ++c) at.span.data[c] = as_cubic(span.data[c]);
}

/// The panel, or that part of it, always one of the two that are left, for which it does.
PanelSegment<double> part_that_does(MultivariateCase& at, Maker& maker, Grade grade,
                                    double tolerance, Data data, int& cuts) {
  std::vector<ChannelTable<double>> storage;
  const MultivariateTransfer<double> transfer = at.view(storage);
  PanelDemand<double> demand = demand_of(at, grade, false);
  const auto allowance = [&](double) { return tolerance; };
  for (cuts = 0;; ++cuts) {
    demand.last_resort = cuts == 50;
    const PanelSegment<double> panel =
        data == Data::linear
            ? integrate_multivariate_panel(transfer, linear_span(at), demand, allowance)
            : integrate_multivariate_panel(transfer, at.span, demand, allowance);
    if (panel.done) return panel;
    EXPECT_GT(panel.cut, 0);
    EXPECT_LT(panel.cut, 1);
    at.span = maker.pick(2) == 0 ? at.span.part(at.channels, 0, panel.cut)
                                 : at.span.part(at.channels, panel.cut, 1);
    if (data == Data::linear) straighten(at);
  }
}

/// Random panels, cut until they do: none is further off than it says, alone or in front of any
/// backdrop, nor says more than is allowed.
void expect_within_error(Grade grade, double tolerance, int tables, long count, unsigned seed,
                         Data data = Data::cubic) {
  Maker maker(seed);
  ErrorRecord share("pixel error / error(), tolerance " + std::to_string(std::log10(tolerance)),
                    ""),
      opacity("opacity error / opacity_error", "");
  long clear = 0, nodes = 0, all_cuts = 0, last = 0;
  for (long i = 0; i < count; ++i) {
    MultivariateCase at(maker, 4, tables);
    if (data == Data::linear) straighten(at);
    int cuts = 0;
    const PanelSegment<double> panel = part_that_does(at, maker, grade, tolerance, data, cuts);
    std::vector<ChannelTable<double>> storage;
    const test::WideStretch truth = test::wide_multivariate(at.view(storage), at.span);
    const long double error = static_cast<long double>(panel.error(at.largest_color));
    const std::string where = "panel " + std::to_string(i);
    const long double scale = static_cast<long double>(at.largest_color) * slack;
    share.add(test::pixel_error(panel.found.segment, truth, at.largest_color) / (error + scale),
              where);
    opacity.add(std::fabs(static_cast<long double>(panel.found.segment.opacity) - truth.opacity()) /
                    (static_cast<long double>(panel.found.opacity_error) + slack),
                where);
    ASSERT_GE(static_cast<long double>(panel.opacity), truth.opacity() - slack) << where;
    ASSERT_GE(panel.found.segment.radiance.r, 0) << where;
    last += cuts == 50;
    if (cuts < 50) {
      ASSERT_LE(panel.error(at.largest_color), tolerance) << where;
    }
    ASSERT_TRUE(panel.found.proved || grade == Grade::estimated) << where;
    clear += panel.found.segment.opacity == 0;
    nodes += panel.found.panels;
    all_cuts += cuts;
  }
  share.print();
  opacity.print();
  std::printf("[ accuracy ] clear %ld, by nodes %ld, as a last resort %ld of %ld; %.1f cuts\n",
              clear, nodes, last, count,
              static_cast<double>(all_cuts) / static_cast<double>(count));
  EXPECT_LE(share.largest(), 1);
  EXPECT_LE(opacity.largest(), 1);
  EXPECT_LT(clear, count / 2);
  // A jump of a table that the data lie on is never resolved.
  EXPECT_LE(last, tables > 0 ? count / 20 : 0);
  if (grade == Grade::proved) {
    EXPECT_EQ(nodes, 0);
  } else if (tables == 0 && tolerance < 1e-3) {
    EXPECT_GT(nodes, count / 20);
  }
}

TEST(MultivariatePanel, ProvedErrorsHoldForGaussians) {
  unsigned seed = 40;
  for (const double tolerance : {1e-1, 1e-3, 1e-5, 1e-7, 1e-9}) {
    expect_within_error(Grade::proved, tolerance, 0, test::span_count(1500), ++seed);
  }
}
TEST(MultivariatePanel, ProvedErrorsHoldWithTables) {
  unsigned seed = 50;
  for (const double tolerance : {1e-1, 1e-2, 1e-4, 1e-6, 1e-9}) {
    expect_within_error(Grade::proved, tolerance, 3, test::span_count(1000), ++seed);
  }
}
TEST(MultivariatePanel, ProvedErrorsHoldForLinearData) {
  unsigned seed = 80;
  for (const double tolerance : {1e-1, 1e-3, 1e-5, 1e-9}) {
    expect_within_error(Grade::proved, tolerance, 0, test::span_count(1000), ++seed, Data::linear);
    expect_within_error(Grade::proved, tolerance, 3, test::span_count(500), ++seed, Data::linear);
  }
}
TEST(MultivariatePanel, EstimatesHoldForLinearData) {
  unsigned seed = 90;
  for (const double tolerance : {1e-2, 1e-4, 1e-9}) {
    expect_within_error(Grade::estimated, tolerance, 0, test::span_count(1000), ++seed,
                        Data::linear);
  }
}
TEST(MultivariatePanel, EstimatesHoldForGaussians) {
  unsigned seed = 60;
  for (const double tolerance : {1e-1, 1e-2, 1e-4, 1e-6, 1e-9}) {
    expect_within_error(Grade::estimated, tolerance, 0, test::span_count(1500), ++seed);
  }
}
TEST(MultivariatePanel, EstimatesHoldWithTables) {
  unsigned seed = 70;
  for (const double tolerance : {1e-2, 1e-5, 1e-9}) {
    expect_within_error(Grade::estimated, tolerance, 3, test::span_count(800), ++seed);
  }
}

/// The share of its error that a panel is off by, when it has to do as it is.
long double forced_share(const MultivariateCase& at) {
  std::vector<ChannelTable<double>> storage;
  const MultivariateTransfer<double> transfer = at.view(storage);
  const PanelSegment<double> panel = integrate_multivariate_panel(
      transfer, at.span, demand_of(at, Grade::proved, true), [](double) { return 1e-9; });
  EXPECT_TRUE(panel.done);
  const long double error = static_cast<long double>(panel.error(at.largest_color));
  return test::pixel_error(panel.found.segment, test::wide_multivariate(transfer, at.span),
                           at.largest_color) /
         (error + slack * static_cast<long double>(at.largest_color));
}

TEST(MultivariatePanel, ProvedErrorsHoldForWhatHasToDo) {
  Maker maker(81);
  ErrorRecord share("last resort, pixel error / error()", "");
  for (long i = 0; i < test::span_count(6000); ++i) {
    const MultivariateCase at(maker, 4, i % 2 == 0 ? 0 : 3);
    share.add(forced_share(at), std::to_string(i));
  }
  share.print();
  EXPECT_LE(share.largest(), 1);
}

/// A light primitive whose density goes up and down about its mean, seen through a heavy black one:
/// its depth stays, what is seen of it does not.
TEST(MultivariatePanel, WhatIsMovedWithinAPanelIsCharged) {
  Maker maker(83);
  ErrorRecord share("moved within, pixel error / error()", "");
  for (int i = 0; i < 4000; ++i) {
    MultivariateCase at(maker, 0, 0);
    at.channels = 1;
    at.largest_color = 1;
    at.span.length = 1;
    Gaussian<double> heavy, light;
    heavy.peak = maker.powers(0.5, 20);
    light.peak = maker.powers(1e-4, 1e-2);
    light.matrix[0][0] = 1;
    light.color = {1, 1, 1};
    at.gaussians = {heavy, light};
    // a + q (1 - 6 u + 6 u²) + r (-1 + 12 u - 30 u² + 20 u³)
    const double a = maker.uniform(0.3, 1.2), size = maker.powers(1e-5, 1e-2);
    const double q = size * maker.normal(), r = size * maker.normal();
    at.span.data[0] = {{a + q - r, a - q + 3 * r, a - q - 3 * r, a + q + r}};
    share.add(forced_share(at), std::to_string(i));
  }
  share.print();
  EXPECT_LE(share.largest(), 1);
  EXPECT_GT(share.largest(), 0.05L);
}

TEST(MultivariatePanel, ProvedErrorsHoldUnderHillClimbing) {
  for (const int tables : {0, 2}) {
    Maker maker(static_cast<unsigned>(82 + tables));
    long double worst = 0;
    for (int start = 0; start < 30; ++start) {
      MultivariateCase best(maker, 3, tables);
      long double found = forced_share(best);
      for (int i = 0; i < 15; ++i) {
        const MultivariateCase other(maker, 3, tables);
        const long double its = forced_share(other);
        if (its > found) {
          best = other;
          found = its;
        }
      }
      double step = 0.3;
      for (int i = 0; i < 120; ++i) {
        MultivariateCase next = best;
        next.mutate(maker, step);
        const long double its = forced_share(next);
        if (its > found) {
          best = next;
          found = its;
        } else {
          step = std::max(0.97 * step, 1e-3);
        }
      }
      worst = std::max(worst, found);
    }
    std::printf("[ accuracy ] hill climbing with %d tables reaches %.3Lf of error()\n", tables,
                worst);
    EXPECT_LE(worst, 1);
    EXPECT_GT(worst, 0.1L);
  }
}

/// A panel of Gaussians seen at Gauß nodes, and the limits of its estimate.
struct EstimatedPanel {
  static constexpr int parts = 16;
  MultivariateCase at;
  explicit EstimatedPanel(Maker& maker) : at(maker, 3, 0) {
    at.span.length = 1;
    for (int c = 0; c < at.channels; ++c) {
      const double size = maker.powers(0.02, 3),
                   bent = maker.pick(2) == 0 ? 1 : maker.powers(1e-4, 1);
      const double a = maker.normal(), b = maker.normal();
      for (int k = 0; k < 4; ++k) {
        at.span.data[c].b[k] = size * (a + k * (b - a) / 3 + bent * maker.normal());
      }
    }
    for (std::size_t i = 0; i < at.gaussians.size(); ++i) {
      Gaussian<double>& g = at.gaussians[i];
      const double far = maker.powers(0.1, 5);
      for (int c = 0; c < at.channels; ++c) {
        g.center[c] = far * maker.normal();
        for (int r = 0; r < g.rows; ++r) g.matrix[r][c] = maker.normal();
      }
      g.peak = maker.powers(0.05, 20);
      g.color = {static_cast<double>(i % 2), 0, 0};
    }
  }

  double exponents() const {
    double range = 0;
    for (const Gaussian<double>& g : at.gaussians) {
      const GaussianCubic<double> cubic(g, at.span.data);
      range = std::max(range, cubic.upper() - cubic.lower());
    }
    return range;
  }
  /// How much an exponent differs from that of its line, at most.
  double bend() const {
    double bend = 0;
    for (const Gaussian<double>& g : at.gaussians) {
      const GaussianCubic<double> cubic(g, at.span.data);
      const auto line = cubic.line();
      bend = std::max(bend, (2 * std::sqrt(cubic.upper()) + line.farthest) * line.farthest);
    }
    return bend;
  }

  /// Scales it to the limits; false where that cannot be done.
  bool legal(double limit) {
    double range = exponents();
    for (int i = 0; i < 8 && range > limit; ++i) {
      for (Gaussian<double>& g : at.gaussians) {
        for (auto& row : g.matrix) {
          for (double& x : row) x *= 0.999 * std::sqrt(limit / range);
        }
      }
      range = exponents();
    }
    if (!(range <= limit) || !(8 * bend() <= limit)) return false;
    double most = 0;
    for (const Gaussian<double>& g : at.gaussians) {
      most += g.peak * std::exp(-GaussianCubic<double>(g, at.span.data).lower());
    }
    if (!(most > 1e-12)) return false;
    for (Gaussian<double>& g : at.gaussians) g.peak /= std::max(most, 1.0);
    return true;
  }

  Material<double> material(double u) const {
    double v[max_channels];
    for (int c = 0; c < at.channels; ++c) v[c] = evaluate(at.span.data[c], u);
    double extinction = 0, emission = 0;
    for (const Gaussian<double>& g : at.gaussians) {
      const double here = g.peak * g.density(v);
      extinction += here;
      emission += here * g.color.r;
    }
    return extinction > 0 ? Material<double>{extinction, {emission / extinction, 0, 0}}
                          : Material<double>{};
  }

  template <int N>
  double error() const {
    SegmentResult<double> truth;
    for (int i = 0; i < parts; ++i) {
      truth = compose(
          truth, gauss_panel<10>(1.0 / parts, [&](double u) { return material((i + u) / parts); }));
    }
    if (!(truth.opacity > 1e-9)) return -1;
    const auto panel = gauss_panel<N>(1.0, [&](double u) { return material(u); });
    return std::fabs(panel.radiance.r / panel.opacity - truth.radiance.r / truth.opacity);
  }
};

template <int N>
void expect_estimate(unsigned seed) {
  Maker maker(seed);
  for (const double limit : {0.25, 0.5, 1.0, 2.0}) {
    double worst = 0;
    for (int start = 0; start < 30; ++start) {
      EstimatedPanel best(maker);
      double found = -1;
      for (int i = 0; i < 60; ++i) {
        EstimatedPanel other(maker);
        if (!other.legal(limit)) continue;
        const double its = other.error<N>();
        if (its > found) {
          best = other;
          found = its;
        }
      }
      double step = 0.3;
      for (int i = 0; i < 400 && found > 0; ++i) {
        EstimatedPanel next = best;
        next.at.mutate(maker, step);
        if (next.at.gaussians.empty() || !next.legal(limit)) continue;
        const double its = next.error<N>();
        if (its > found) {
          best = next;
          found = its;
        } else {
          step = std::max(0.985 * step, 1e-3);
        }
      }
      worst = std::max(worst, found);
    }
    const double estimate = cubic_panel_estimate<N>(limit);
    std::printf("[ accuracy ] %d nodes, exponents <= %g: found %.2g, estimate %.2g\n", N, limit,
                worst, estimate);
    EXPECT_LE(worst, 0.5 * estimate + 2e-14) << N << ' ' << limit;
    EXPECT_GT(worst, 0.01 * estimate) << "nothing was found";
  }
  EXPECT_EQ(cubic_panel_estimate<N>(2.001), 1.0);
}

TEST(CubicPanelEstimate, HoldsUnderHillClimbing) {
  expect_estimate<2>(92);
  expect_estimate<3>(93);
  expect_estimate<4>(94);
  expect_estimate<6>(96);
  expect_estimate<8>(98);
}

/// One primitive over one channel, on data from -1 to 1.
struct Plain {
  Gaussian<double> g;
  MultivariateSpan<double> span;
  PanelDemand<double> demand;
  Plain() {
    g.matrix[0][0] = 1;
    g.peak = 1;
    g.color = {1, 0.5, 0};
    span.data[0] = {{-1, -1.0 / 3, 1.0 / 3, 1}};
    span.length = 1;
    demand.last_resort = true;
  }
  PanelSegment<double> panel() const {
    MultivariateTransfer<double> transfer;
    transfer.gaussians = {&g, 1};
    return integrate_multivariate_panel(transfer, span, demand, [](double) { return 1e-6; });
  }
};

TEST(MultivariatePanel, OnePrimitiveOnALineIsExact) {
  Plain plain;
  plain.demand.last_resort = false;
  const PanelSegment<double> panel = plain.panel();
  ASSERT_TRUE(panel.done);
  const double depth = 0.5 * std::sqrt(std::acos(-1.0)) * std::erf(1.0);
  EXPECT_NEAR(panel.found.segment.optical_depth, depth, 1e-15);
  EXPECT_NEAR(panel.found.segment.radiance.g, 0.5 * -std::expm1(-depth), 1e-15);
  EXPECT_LE(panel.error(1), 1e-12);
  EXPECT_EQ(panel.found.segment.radiance.b, 0);
}

TEST(MultivariatePanel, NothingToSee) {
  Plain plain;
  plain.g.peak = 0;
  EXPECT_EQ(plain.panel().found.segment.opacity, 0);
  EXPECT_TRUE(plain.panel().done);
  EXPECT_EQ(plain.panel().error(1), 0);
  plain = Plain();
  plain.span.length = 0;
  EXPECT_TRUE(plain.panel().done);
  EXPECT_EQ(plain.panel().found.segment.opacity, 0);
  EXPECT_LE(plain.panel().error(1), 1e-15);
  plain = Plain();
  plain.demand.primitives.bits = ~1ULL;
  EXPECT_EQ(plain.panel().found.segment.opacity, 0);
}

TEST(MultivariatePanel, PrimitivesBeyond64GoByTheirRemainder) {
  std::vector<Gaussian<double>> many(130, Plain().g);
  for (Gaussian<double>& g : many) g.peak = 0;
  many[129].peak = 1;
  MultivariateTransfer<double> transfer;
  transfer.gaussians = {many.data(), 130};
  Plain plain;
  const auto of = [&](unsigned long long bits) {
    plain.demand.primitives.bits = bits;
    return integrate_multivariate_panel(transfer, plain.span, plain.demand,
                                        [](double) { return 1e-6; });
  };
  EXPECT_GT(of(2).found.segment.opacity, 0.4);
  EXPECT_EQ(of(~2ULL).found.segment.opacity, 0);
}

/// A primitive wider than anything is a constant.
TEST(MultivariatePanel, HugeWidthsAndNone) {
  for (const double k : {0.0, 1e-300, 1e-30, 1e-12}) {
    Plain plain;
    plain.g.matrix[0][0] = k;
    plain.demand.last_resort = false;
    const PanelSegment<double> panel = plain.panel();
    ASSERT_TRUE(panel.done) << k;
    EXPECT_NEAR(panel.found.segment.optical_depth, 1, 1e-14) << k;
    EXPECT_LE(panel.error(1), 1e-9) << k;
  }
}

TEST(MultivariatePanel, ConstantData) {
  for (const double value : {0.0, 0.7, 3.0, 30.0, 1e8}) {
    Plain plain;
    plain.span.data[0] = {{value, value, value, value}};
    plain.demand.last_resort = false;
    const PanelSegment<double> panel = plain.panel();
    ASSERT_TRUE(panel.done) << value;
    const double depth = std::exp(-value * value);
    EXPECT_NEAR(panel.found.segment.opacity, -std::expm1(-depth), 1e-15 + panel.found.opacity_error)
        << value;
    EXPECT_LE(panel.error(1), 1e-6) << value;
  }
}

TEST(MultivariatePanel, EnormousPeaksAreOpaque) {
  Plain plain;
  plain.g.peak = 1e30;
  const PanelSegment<double> panel = plain.panel();
  EXPECT_TRUE(panel.done);
  EXPECT_EQ(panel.opacity, 1);
  EXPECT_EQ(panel.found.segment.opacity, 1);
  EXPECT_NEAR(panel.found.segment.radiance.g, 0.5, 1e-15);
  EXPECT_LE(panel.found.opacity_error, 1);
  EXPECT_TRUE(std::isfinite(panel.error(1)));
}

/// 1e8 widths from the center and all along a face of it: K sees a difference of large numbers.
TEST(MultivariatePanel, FarFromTheCenter) {
  Maker maker(99);
  ErrorRecord share("far from the center, pixel error / error()", "");
  for (int i = 0; i < 2000; ++i) {
    MultivariateCase at(maker, 0, 0);
    at.gaussians.clear();
    Gaussian<double> g;
    at.channels = g.channels = 2;
    g.rows = 1;
    const double far = maker.powers(1, 1e9);
    // Along (1, 1) K sees nothing.
    g.matrix[0][0] = 1;
    g.matrix[0][1] = -1;
    for (int k = 0; k < 4; ++k) {
      const double along = far * (1 + 0.1 * maker.normal());
      at.span.data[0].b[k] = along + maker.normal();
      at.span.data[1].b[k] = along + maker.normal();
    }
    g.peak = maker.powers(0.1, 10);
    g.color = {1, 0.5, 0};
    at.gaussians = {g, g};
    at.gaussians[1].color = {0, 1, 1};
    at.gaussians[1].center[0] = maker.normal();
    at.span.length = 1;
    at.largest_color = 1;
    share.add(forced_share(at), "far " + std::to_string(far));
  }
  share.print();
  EXPECT_LE(share.largest(), 1);
}

/// Ends that are off move the depth by the extinction there.
TEST(MultivariatePanel, EndsThatAreOffAreCharged) {
  Plain plain;
  const double before = plain.panel().found.opacity_error;
  plain.demand.position_error = 1e-4;
  const double after = plain.panel().found.opacity_error;
  EXPECT_GE(after - before, 1e-4);
  EXPECT_LE(after - before, 1.01e-4);
}

/// Numbers of any size: finite, in gamut, never an error that is not a number.
TEST(MultivariatePanel, EdgesAreFiniteAndInGamut) {
  const double numbers[] = {0, 1e-300, 1, -3, 1e15, 2.1e37};
  for (const double k : {0.0, 1e-30, 1.0, 1e15, 2.1e37}) {
    for (const double peak : {0.0, 1e-300, 1.0, 2.1e37}) {
      for (const double a : numbers) {
        for (const double b : numbers) {
          for (const double length : {0.0, 1e-300, 1.0, 1e10}) {
            Plain plain;
            plain.g.matrix[0][0] = k;
            plain.g.peak = peak;
            plain.span.data[0] = {{a, b, a, b}};
            plain.span.length = length;
            const PanelSegment<double> panel = plain.panel();
            SCOPED_TRACE(testing::Message()
                         << k << ", " << peak << ", " << length << ": " << a << " " << b);
            ASSERT_TRUE(panel.done);
            ASSERT_TRUE(std::isfinite(panel.error(1)));
            ASSERT_GE(panel.found.segment.radiance.r, 0);
            ASSERT_LE(panel.found.segment.radiance.r,
                      panel.found.segment.opacity * (1 + 16 * rounding_unit<double>));
            ASSERT_LE(panel.found.opacity_error, 1);
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace pellucid::test_multivariate_panel
