// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "expect_error.h"
#include "pellucid/scene/scene.h"

namespace pellucid::test_integration {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(Tolerance, TheNearestWithinTheLimits) {
  EXPECT_EQ(Integration{}.tolerance, 1.0 / 512);
  const struct {
    double wanted, used;
  } cases[] = {{1e-3, 1e-3},
               {smallest_tolerance, smallest_tolerance},
               {largest_tolerance, largest_tolerance},
               {std::nextafter(smallest_tolerance, 0), smallest_tolerance},
               {std::nextafter(largest_tolerance, 2), largest_tolerance},
               {1e-300, smallest_tolerance},
               {std::numeric_limits<double>::denorm_min(), smallest_tolerance},
               {1e300, largest_tolerance},
               {infinity, largest_tolerance}};
  for (const auto& [wanted, used] : cases) {
    EXPECT_EQ(nearest_tolerance(wanted), used) << wanted;
  }
}

TEST(Tolerance, NoneIsNearestToWhatIsNotPositive) {
  for (const double bad : {0.0, -0.0, -1e-3, -infinity, nan}) {
    expect_error([&] { nearest_tolerance(bad); },
                 {"integration: tolerance is", "positive", "0.001953125"});
  }
}

TEST(CheckIntegration, TakesTheDefaultsAndTheLimits) {
  Scene scene;
  EXPECT_NO_THROW(check_integration(scene));
  for (const int samples : {1, 2, largest_samples}) {
    scene.samples = samples;
    EXPECT_NO_THROW(check_integration(scene));
  }
  for (const double tolerance : {smallest_tolerance, largest_tolerance}) {
    scene.integration.tolerance = tolerance;
    EXPECT_NO_THROW(check_integration(scene));
  }
  scene.integration.method = Method::linear;
  for (const double step : {smallest_step, largest_step}) {
    scene.integration.step = step;
    EXPECT_NO_THROW(check_integration(scene));
  }
}

TEST(CheckIntegration, NamesWhatIsBeyondItsLimits) {
  Scene scene;
  for (const int bad : {std::numeric_limits<int>::min(), -1, 0, largest_samples + 1,
                        std::numeric_limits<int>::max()}) {
    scene.samples = bad;
    expect_error([&] { check_integration(scene); },
                 {"scene: samples is", std::to_string(bad).c_str(), "from 1 to 64"});
  }
  scene.samples = 1;
  for (const double bad :
       {nan, -1.0, 0.0, std::nextafter(smallest_tolerance, 0), 1.5, infinity, -infinity}) {
    scene.integration.tolerance = bad;
    expect_error([&] { check_integration(scene); },
                 {"integration: tolerance is", "from 1e-07 to 1"});
  }
  scene = {};
  scene.integration.method = Method::midpoint;
  for (const double bad : {nan, -1.0, 0.0, 0.9999e-4, 1.0001e6, infinity}) {
    scene.integration.step = bad;
    expect_error([&] { check_integration(scene); },
                 {"integration: step is", "voxels", "from 1e-04 to 1e+06"});
  }
}

TEST(CheckIntegration, LooksAtWhatTheMethodUsesOnly) {
  Scene scene;
  scene.integration.step = nan;
  EXPECT_NO_THROW(check_integration(scene));
  scene.integration = {};
  scene.integration.method = Method::simpson;
  scene.integration.tolerance = nan;
  EXPECT_NO_THROW(check_integration(scene));
}

}  // namespace
}  // namespace pellucid::test_integration
