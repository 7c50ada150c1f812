// SPDX-License-Identifier: Apache-2.0
#include "pellucid/render/sample_ray.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pellucid/render/integrate_ray.h"
#include "tests/render/test_grid.h"

namespace pellucid::test_sample_ray {
namespace {

constexpr SegmentRule rules[] = {SegmentRule::rectangle, SegmentRule::taylor,
                                 SegmentRule::midpoint,  SegmentRule::trapezoid,
                                 SegmentRule::simpson,   SegmentRule::linear};

TEST(SampleRay, EveryRuleConvergesToTheSameIntegral) {
  const TestGrid<float> grid(9);
  const TestTable<double> table;
  const Ray<double> ray = oblique_ray(9);
  const RayResult exact = exact_ray(grid, ray, Precision::float64, false);
  for (const SegmentRule rule : rules) {
    const auto error = [&](double step) {
      const RayResult r =
          sample_ray<double>(grid.view(), ray, table.view(), rule, step, 1, 0, false);
      return std::abs(r.opacity - exact.opacity) + std::abs(r.radiance.g - exact.radiance.g);
    };
    EXPECT_LT(error(1e-4), 2e-3) << static_cast<int>(rule);
    EXPECT_LT(error(1e-4), 0.2 * error(0.5)) << static_cast<int>(rule);
  }
}

TEST(SampleRay, TheLastStepEndsAtTheBox) {
  TestGrid<float> grid(4);
  for (float& v : grid.data) v = 0.45f;
  const TestTable<double> table;
  const double extinction = table.view().evaluate(static_cast<double>(0.45f)).extinction;
  for (const double step : {0.7, 1.0, 2.9, 3.0, 100.0}) {
    const RayResult r = sample_ray<double>(grid.view(), {{-1, 1, 1}, {1, 0, 0}}, table.view(),
                                           SegmentRule::midpoint, step, 1, 0, false);
    EXPECT_NEAR(r.optical_depth, 3 * extinction, 1e-14) << step;
    EXPECT_EQ(r.cells, static_cast<long>(std::ceil(3 / step))) << step;
  }
}

TEST(SampleRay, TheEyeInsideSeesWhatIsInFrontOfIt) {
  TestGrid<float> grid(4);
  for (float& v : grid.data) v = 0.45f;
  const TestTable<double> table;
  const double extinction = table.view().evaluate(static_cast<double>(0.45f)).extinction;
  const RayResult r = sample_ray<double>(grid.view(), {{1, 1, 1}, {1, 0, 0}}, table.view(),
                                         SegmentRule::linear, 0.25, 1, 0, false);
  EXPECT_NEAR(r.optical_depth, 2 * extinction, 1e-14);
}

TEST(SampleRay, NanIsVacuum) {
  TestGrid<double> grid(4);
  for (double& v : grid.data) v = std::numeric_limits<double>::quiet_NaN();
  const TestTable<double> table;
  for (const SegmentRule rule : rules) {
    const RayResult r =
        sample_ray<double>(grid.view(), oblique_ray(4), table.view(), rule, 0.1, 1, 0, true);
    EXPECT_EQ(r.opacity, 0);
    EXPECT_EQ(r.radiance, Rgb<double>{});
    EXPECT_TRUE(std::isinf(r.half_opacity_depth));
  }
}

}  // namespace
}  // namespace pellucid::test_sample_ray
