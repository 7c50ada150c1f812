// SPDX-License-Identifier: Apache-2.0
#include "pellucid/render/integrate_ray.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "tests/render/test_grid.h"

namespace pellucid::test_integrate_ray {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(Spans, JoinInPlaceAndValue) {
  const TestGrid<float> grid(9);
  double t = -1, value = 0;
  const long cells = for_each_span<double>(grid.view(), oblique_ray(9), [&](const auto& span) {
    if (t >= 0) {
      EXPECT_EQ(span.t_begin, t);
      EXPECT_NEAR(span.data.b[0], value, 1e-13);
    }
    EXPECT_GT(span.length(), 0);
    t = span.t_end;
    value = span.data.b[3];
    return true;
  });
  EXPECT_GT(cells, 8);
}

TEST(Spans, EndWhereTheVisitorSaysSo) {
  const TestGrid<float> grid(9);
  int visits = 0;
  EXPECT_EQ(
      for_each_span<float>(grid.view(), oblique_ray(9), [&](const auto&) { return ++visits < 3; }),
      3);
}

TEST(Spans, PassOverCellsWithANanCorner) {
  TestGrid<double> grid(5);
  grid.at(2, 2, 2) = nan;
  // Along x through the middle of the cells j = k = 1: cells 1 and 2 touch the NaN.
  const Ray<double> ray{{-1, 1.5, 1.5}, {1, 0, 0}};
  std::vector<double> begins;
  EXPECT_EQ(for_each_span<double>(grid.view(), ray,
                                  [&](const auto& span) {
                                    begins.push_back(span.t_begin);
                                    return true;
                                  }),
            4);
  EXPECT_EQ(begins, (std::vector<double>{1, 4}));
}

TEST(IntegrateRay, FloatAndDoubleAgreeWithinWhatTheySay) {
  const TestGrid<float> grid(33);
  const Ray<double> ray = oblique_ray(33);
  const RayResult b = exact_ray(grid, ray, Precision::float64, false);
  EXPECT_GT(b.opacity, 0.5);
  EXPECT_LE(b.error, 1e-9);
  for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
    for (const Precision precision : {Precision::automatic, Precision::float32}) {
      const RayResult a = exact_ray(grid, ray, precision, false, tolerance);
      const double error = a.error + b.error;
      EXPECT_LE(std::abs(a.opacity - b.opacity), error);
      EXPECT_LE(std::abs(a.radiance.r - b.radiance.r), error);
      EXPECT_LE(std::abs(a.radiance.g - b.radiance.g), error);
      EXPECT_LE(std::abs(a.radiance.b - b.radiance.b), error);
      if (precision == Precision::automatic) {
        EXPECT_LE(a.error, tolerance);
      }
    }
  }
}

TEST(IntegrateRay, BinarySixtyFourStepsInWhereBinaryThirtyTwoDoesNotDo) {
  const TestGrid<float> grid(33);
  const Ray<double> ray = oblique_ray(33);
  EXPECT_EQ(exact_ray(grid, ray, Precision::float32, false, 1e-7).spans.in_double, 0u);
  EXPECT_GT(exact_ray(grid, ray, Precision::float32, false, 1e-7).error, 1e-7);
  EXPECT_GT(exact_ray(grid, ray, Precision::automatic, false, 1e-7).spans.in_double, 10u);
}

TEST(IntegrateRay, ALooserToleranceTakesNoMoreCells) {
  const TestGrid<float> grid(33);
  long cells = 0;
  for (const double tolerance : {0.5, 1e-1, 1e-2, 1e-4, 1e-6}) {
    const RayResult r = exact_ray(grid, oblique_ray(33), Precision::automatic, false, tolerance);
    EXPECT_GE(r.cells, cells);
    cells = r.cells;
  }
  EXPECT_GT(cells, exact_ray(grid, oblique_ray(33), Precision::automatic, false, 0.5).cells);
}

/// In front of what is opaque a ray is off by what it leaves out: a quarter of its tolerance at
/// most, and most of that.
TEST(IntegrateRay, EndsWhereAQuarterOfItsTolerancePaysForTheRest) {
  TestGrid<float> grid(33);
  for (float& v : grid.data) v = 0.5f;
  int ended = 0;
  for (const double extinction : {0.3, 0.5, 0.7, 0.9}) {
    const double value[2] = {0, 1};
    const Material<double> material[2] = {{extinction, {1, 1, 1}}, {extinction, {1, 1, 1}}};
    const float single_value[2] = {0, 1};
    const auto single_extinction = static_cast<float>(extinction);
    const Material<float> single_material[2] = {{single_extinction, {1, 1, 1}},
                                                {single_extinction, {1, 1, 1}}};
    const PiecewiseLinear<double> wide{value, material, 2};
    const PiecewiseLinear<float> single{single_value, single_material, 2};
    const AntiderivativeStorage<float> single_antiderivative(single);
    const AntiderivativeStorage<double> wide_antiderivative(wide);
    const TransferTables tables{single, wide, single_antiderivative.view(),
                                wide_antiderivative.view(), extinction};
    for (const double tolerance : {1e-1, 1e-2, 1e-3, 1e-4}) {
      const auto off_by = [&](double of) {
        const RayResult r = integrate_ray(grid.view(), nullptr, oblique_ray(33), tables,
                                          {of, Grade::estimated, Precision::float64, 1}, false);
        return std::make_pair(r.opacity, r.error);
      };
      const auto exact = off_by(1e-12), found = off_by(tolerance);
      const double error = exact.first - found.first;
      EXPECT_LE(error, 0.25 * tolerance) << extinction << ' ' << tolerance;
      EXPECT_GE(found.second, error);
      ended += error > 0.1 * tolerance;
    }
  }
  EXPECT_GT(ended, 8);
}

TEST(IntegrateRay, HalfOpacityDepthHalvesTheOpacity) {
  const TestGrid<float> grid(17);
  const TestTable<double> table;
  Ray<double> ray = oblique_ray(17);
  const RayResult whole = exact_ray(grid, ray, Precision::float64, true);
  ASSERT_GT(whole.opacity, 0.2);
  // The opacity up to a place, by a fine midpoint rule from outside in the same data.
  double depth = 0;
  constexpr int n = 400000;
  const double begin = 0, step = (whole.half_opacity_depth - begin) / n;
  for (int i = 0; i < n; ++i) {
    const Vec3<double> p = ray.at(begin + (i + 0.5) * step);
    if (p.x < 0 || p.y < 0 || p.z < 0 || p.x > 16 || p.y > 16 || p.z > 16) continue;
    const int c[3] = {static_cast<int>(p.x), static_cast<int>(p.y), static_cast<int>(p.z)};
    double v = 0;
    for (int k = 0; k < 8; ++k) {
      const int d[3] = {k & 1, (k >> 1) & 1, k >> 2};
      double w = 1;
      for (int a = 0; a < 3; ++a) w *= d[a] != 0 ? p[a] - c[a] : 1 - (p[a] - c[a]);
      v += w * static_cast<double>(grid.data[static_cast<std::size_t>(
                   c[0] + d[0] + 17 * (c[1] + d[1] + 17 * (c[2] + d[2])))]);
    }
    depth += table.view().evaluate(v).extinction * step;
  }
  EXPECT_NEAR(1 - std::exp(-depth), 0.5 * whole.opacity, 1e-4);
}

TEST(IntegrateRay, ARayThatMissesIsClear) {
  const TestGrid<float> grid(5);
  const RayResult r = exact_ray(grid, {{100, 0, 0}, {0, 0, 1}}, Precision::automatic, true);
  EXPECT_EQ(r.error, 0);
  EXPECT_TRUE(r.proved);
  EXPECT_EQ(r.opacity, 0);
  EXPECT_EQ(r.cells, 0);
  EXPECT_TRUE(std::isinf(r.half_opacity_depth));
}

TEST(IntegrateRay, WorldLengthIsTheParameterNotTheGridLength) {
  // The same ray with half the direction in the grid: cells twice as long in the world.
  TestGrid<float> grid(3);
  for (float& v : grid.data) v = 0.45f;
  const TestTable<double> table;
  const double extinction = table.view().evaluate(static_cast<double>(0.45f)).extinction;
  const RayResult r = exact_ray(grid, {{-1, 1, 1}, {0.5, 0, 0}}, Precision::float64, false);
  EXPECT_NEAR(r.optical_depth, 4 * extinction, 1e-14);
}

}  // namespace
}  // namespace pellucid::test_integrate_ray
