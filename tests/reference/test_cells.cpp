// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <boost/math/quadrature/tanh_sinh.hpp>
#include <cmath>
#include <random>

#include "src/reference/grid/piece.h"
#include "tests/support/accuracy.h"
#include "tests/support/table.h"

namespace pellucid::reference::test_cells {
namespace {

using Points = std::vector<TransferFunction::Point>;

ReferencePixel integrate_cell(const Chord& chord, const Points& points, Real length) {
  Gatherer gatherer;
  for_each_piece(chord, Table(points), 0, length, [&](const Piece& piece) {
    gatherer.add(piece);
    return true;
  });
  return gatherer.result();
}

Real3 triple(const std::vector<double>& v) {
  return {Real(v.at(0)), Real(v.at(1)), Real(v.at(2))};
}

/// Against 40-digit values made by other means (tests/reference_tables).
TEST(ReferenceCell, AgreesWithTheTruthTable) {
  const auto table = test::Table::reference("trilinear_cell.csv");
  test::ErrorRecord depth_error("cell, optical depth / (1 + depth)", ""),
      opacity_error("cell, opacity", ""), radiance_error("cell, radiance", "");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (table.text(row, "tf_kind") != "piecewise_linear") continue;
    const auto corners = table.list(row, "corners");
    std::array<Real, 8> corner;
    std::copy(corners.begin(), corners.end(), corner.begin());
    const auto x = table.list(row, "tf_x"), tau = table.list(row, "tf_tau");
    const auto r = table.list(row, "tf_r"), g = table.list(row, "tf_g"),
               b = table.list(row, "tf_b");
    Points points;
    for (std::size_t i = 0; i < x.size(); ++i) points.push_back({x[i], tau[i], {r[i], g[i], b[i]}});
    const Chord chord(corner, triple(table.list(row, "entry")), triple(table.list(row, "exit")));
    const ReferencePixel pixel = integrate_cell(chord, points, table.number(row, "D"));
    const std::string where = "id " + table.text(row, "id") + ", " + table.text(row, "regime");
    const long double depth = table.wide(row, "optical_depth");
    // Beyond 37 the reference stops: nothing behind it can be seen.
    if (depth < 37) {
      depth_error.add(
          std::fabs(static_cast<long double>(pixel.optical_depth) - depth) / (1 + depth), where);
    }
    opacity_error.add(
        std::fabs(static_cast<long double>(pixel.opacity) - table.wide(row, "opacity")), where);
    radiance_error.add(
        std::fabs(static_cast<long double>(pixel.radiance.r) - table.wide(row, "radiance_r")),
        where);
    radiance_error.add(
        std::fabs(static_cast<long double>(pixel.radiance.g) - table.wide(row, "radiance_g")),
        where);
    radiance_error.add(
        std::fabs(static_cast<long double>(pixel.radiance.b) - table.wide(row, "radiance_b")),
        where);
  }
  EXPECT_EQ(opacity_error.count(), 200u);
  for (const auto* record : {&depth_error, &opacity_error, &radiance_error}) {
    record->print();
    EXPECT_LE(record->largest(), 1e-13L);
  }
}

/// The transfer function without intervals, roots or clamps, for quadrature by brute force.
struct PlainTable {
  const Points& points;

  template <class Get>
  Real operator()(Real v, Get&& get) const {
    if (v < points.front().value) return get(points.front());
    for (std::size_t i = 1; i < points.size(); ++i) {
      const Real left = points[i - 1].value, right = points[i].value;
      if (v < right) {
        return (get(points[i - 1]) * (right - v) + get(points[i]) * (v - left)) / (right - left);
      }
    }
    return get(points.back());
  }
};

/// Composite Simpson on n equal steps of the arc length, nested for the depth; knows nothing of
/// control points. Trilinear data as nested linear interpolation.
ReferencePixel brute_force(const std::array<Real, 8>& c, const Real3& entry, const Real3& exit,
                           const Points& points, Real length, int n) {
  const PlainTable table{points};
  const auto lerp = [](Real p, Real q, Real s) { return p + s * (q - p); };
  const auto data = [&](Real u) {
    const Real x = lerp(entry[0], exit[0], u), y = lerp(entry[1], exit[1], u),
               z = lerp(entry[2], exit[2], u);
    return lerp(lerp(lerp(c[0], c[1], x), lerp(c[2], c[3], x), y),
                lerp(lerp(c[4], c[5], x), lerp(c[6], c[7], x), y), z);
  };
  const auto extinction = [](const TransferFunction::Point& p) { return Real(p.extinction); };
  const auto source = [&](Real u, Real depth) {
    const Real v = data(u);
    const auto color = [](const TransferFunction::Point& p) { return Real(p.color.r); };
    return table(v, extinction) * table(v, color) * std::exp(-depth);
  };
  const Real h = length / n;
  Real depth = 0, radiance = 0;
  for (int i = 0; i < n; ++i) {
    const Real u0 = Real(i) / n, u1 = (Real(i) + Real(0.5)) / n, u2 = Real(i + 1) / n;
    const auto tau = [&](Real u) { return table(data(u), extinction); };
    const Real half = h / 2 / 6 * (tau(u0) + 4 * tau((u0 + u1) / 2) + tau(u1));
    const Real whole = half + h / 2 / 6 * (tau(u1) + 4 * tau((u1 + u2) / 2) + tau(u2));
    radiance +=
        h / 6 * (source(u0, depth) + 4 * source(u1, depth + half) + source(u2, depth + whole));
    depth += whole;
  }
  ReferencePixel pixel;
  pixel.optical_depth = static_cast<double>(depth);
  pixel.radiance.r = static_cast<double>(radiance);
  return pixel;
}

TEST(ReferenceCell, AgreesWithBruteForceThatSeesNoControlPoints) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  test::ErrorRecord error("random cells against fine steps", "");
  for (int trial = 0; trial < 40; ++trial) {
    std::array<Real, 8> corner;
    for (Real& v : corner) v = uniform(random);
    // Faces opposite or beside one another, and chords inside the cell.
    Real3 entry{uniform(random), uniform(random), uniform(random)};
    Real3 exit{uniform(random), uniform(random), uniform(random)};
    if (trial % 3 != 0) entry[static_cast<std::size_t>(trial % 2)] = 0;
    if (trial % 3 != 0) exit[2] = 1;
    Points points;
    for (int i = 0; i < 6; ++i) {
      points.push_back({(i + uniform(random)) / 6, 8 * uniform(random), {uniform(random), 0, 0}});
    }
    const ReferencePixel truth = brute_force(corner, entry, exit, points, 1.5, 20000);
    const ReferencePixel pixel = integrate_cell(Chord(corner, entry, exit), points, 1.5);
    const std::string where = "trial " + std::to_string(trial);
    error.add(std::fabs(pixel.optical_depth - truth.optical_depth), where);
    error.add(std::fabs(pixel.radiance.r - truth.radiance.r), where);
  }
  error.print();
  // What the fine steps themselves lose at the kinks.
  EXPECT_LE(error.largest(), 3e-9L);
}

TEST(ReferenceCell, PolynomialIsTheTrilinearFunction) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int trial = 0; trial < 200; ++trial) {
    std::array<Real, 8> corner;
    for (Real& v : corner) v = 1000 * uniform(random);
    const Real3 entry{std::fabs(uniform(random)), 0, std::fabs(uniform(random))};
    const Real3 exit{std::fabs(uniform(random)), std::fabs(uniform(random)), 1};
    const Chord chord(corner, entry, exit);
    const auto& c = chord.monomial();
    for (int i = 0; i <= 16; ++i) {
      const Real u = Real(i) / 16;
      EXPECT_NEAR(static_cast<double>(chord(u)),
                  static_cast<double>(c[0] + u * (c[1] + u * (c[2] + u * c[3]))), 1e-12);
    }
  }
}

/// f = xyz along the diagonal is u³: a control value v is crossed at its cube root, and the
/// stationary point at 0 is an end.
TEST(ReferenceCell, CutsAtCubeRoots) {
  const Chord chord({0, 0, 0, 0, 0, 0, 0, 1}, {0, 0, 0}, {1, 1, 1});
  const std::vector<Real> cuts = chord.cuts({-0.5L, 0.001L, 0.125L, 0.7L, 1.0L, 2.0L});
  ASSERT_EQ(cuts.size(), 3u);
  EXPECT_NEAR(static_cast<double>(cuts[0]), 0.1, 1e-15);
  EXPECT_NEAR(static_cast<double>(cuts[1]), 0.5, 1e-15);
  EXPECT_NEAR(static_cast<double>(cuts[2]), std::cbrt(0.7), 1e-15);
}

/// Along the diagonal a corner counts by the number of its upper ends, and the averages 1, −5, 5,
/// −1 are the Bernstein coefficients of (1 − 2u)(1 − 16u(1 − u)), which vanishes three times.
TEST(ReferenceCell, FindsThreeCrossingsOfOneValue) {
  const Chord chord({1, -5, -5, 5, -5, 5, 5, -1}, {0, 0, 0}, {1, 1, 1});
  const std::vector<Real> values{0};
  std::vector<Real> crossings;
  for (const Real u : chord.cuts(values)) {
    if (std::fabs(chord(u)) < 1e-12L) crossings.push_back(u);
  }
  ASSERT_EQ(crossings.size(), 3u);
  const double off = std::sqrt(0.25 - 1.0 / 16);
  EXPECT_NEAR(static_cast<double>(crossings[0]), 0.5 - off, 1e-14);
  EXPECT_NEAR(static_cast<double>(crossings[1]), 0.5, 1e-14);
  EXPECT_NEAR(static_cast<double>(crossings[2]), 0.5 + off, 1e-14);
}

/// Constant data exactly at a jump belongs to the right of it, whatever the weights round to.
TEST(ReferenceCell, ConstantDataAtAJumpTakesTheRightSide) {
  const double v = 0.1;
  const Points points{{0, 1, {}}, {v, 1, {}}, {v, 3, {}}, {1, 3, {}}};
  std::array<Real, 8> corner;
  corner.fill(v);
  const Chord chord(corner, {0.1L, 0.3L, 0.7L}, {0.9L, 0.2L, 1.0L});
  EXPECT_DOUBLE_EQ(integrate_cell(chord, points, 2).optical_depth, 6);
}

TEST(ReferenceCell, DeepPiecesStayVisible) {
  // Extinction 0 to 1e7 over one cell: the light comes from the first thousandths.
  const Points points{{0, 0, {1, 0, 0}}, {1, 1e7, {0, 1, 0}}};
  const Chord chord({0, 1, 0, 1, 0, 1, 0, 1}, {0, 0.5L, 0.5L}, {1, 0.5L, 0.5L});
  const ReferencePixel pixel = integrate_cell(chord, points, 1);
  // With a = k u²/2: ∫ k u · u · exp(−k u²/2) du = sqrt(π / 2k) up to exp(−k/2).
  EXPECT_NEAR(pixel.radiance.g, std::sqrt(std::acos(-1.0) / 2e7), 1e-15);
  EXPECT_NEAR(pixel.radiance.r, 1 - std::sqrt(std::acos(-1.0) / 2e7), 1e-14);
  EXPECT_NEAR(pixel.opacity, 1, 1e-15);

  // All of the light within 1e-6 of the entry, before the first node of any rule over the cell:
  // ∫ x exp(−xu) u du = 1/x.
  const Points dense{{0, 1e6, {1, 0, 0}}, {1, 1e6, {0, 1, 0}}};
  EXPECT_NEAR(integrate_cell(chord, dense, 1).radiance.g, 1e-6, 1e-18);
}

/// The depth and the share integral of one piece against tanh-sinh in extended precision.
TEST(ReferenceCell, QuadratureAgreesWithTanhSinh) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  boost::math::quadrature::tanh_sinh<long double> integrator;
  test::ErrorRecord error("pieces against tanh-sinh", "");
  for (int trial = 0; trial < 10; ++trial) {
    std::array<Real, 8> corner;
    for (Real& v : corner) v = uniform(random);
    const Points points{{0, 2 * uniform(random), {0, 0, 0}}, {1, 2 * uniform(random), {1, 0, 0}}};
    const Chord chord(corner, {uniform(random), 0, uniform(random)}, {uniform(random), 1, 0});
    const auto rate = [&](Real u) {
      return points[0].extinction + chord(u) * (points[1].extinction - points[0].extinction);
    };
    const auto depth = [&](Real u) {
      return u > 0 ? integrator.integrate(rate, 0.0L, u, 1e-15L) : 0.0L;
    };
    const Real light = integrator.integrate(
        [&](Real u) { return rate(u) * chord(u) * std::exp(-depth(u)); }, 0.0L, 1.0L, 1e-15L);
    const ReferencePixel pixel = integrate_cell(chord, points, 1);
    const std::string where = "trial " + std::to_string(trial);
    error.add(std::fabs(pixel.optical_depth - depth(1)), where);
    error.add(std::fabs(pixel.radiance.r - light), where);
  }
  error.print();
  EXPECT_LE(error.largest(), 1e-14L);
}

}  // namespace
}  // namespace pellucid::reference::test_cells
