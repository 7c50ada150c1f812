// SPDX-License-Identifier: Apache-2.0
#include "charts/axis_ticks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace {

using pellucid::cli::axis_ticks;
using pellucid::cli::count_share;
using pellucid::cli::count_ticks;
using pellucid::cli::Tick;

std::string labels(const std::vector<Tick>& ticks) {
  std::string text;
  for (const Tick& tick : ticks) text += (text.empty() ? "" : " ") + tick.label;
  return text;
}

TEST(AxisTicks, AreRoundNumbers) {
  EXPECT_EQ(labels(axis_ticks(-0.5, 255.5, 6)), "0 50 100 150 200 250");
  EXPECT_EQ(labels(axis_ticks(0, 1, 5)), "0.0 0.2 0.4 0.6 0.8 1.0");
  EXPECT_EQ(labels(axis_ticks(-1024, 3071, 5)), "-1000 0 1000 2000 3000");
  EXPECT_EQ(labels(axis_ticks(0, 3e-9, 4)), "0 1e-09 2e-09 3e-09");
  EXPECT_EQ(labels(axis_ticks(1e9, 1e9 + 4, 4)),
            "1000000000 1000000001 1000000002 1000000003 "
            "1000000004");
}

TEST(AxisTicks, StandWhereTheirNumbersAre) {
  for (const auto& [lower, upper] : std::vector<std::pair<double, double>>{
           {0, 1}, {-3.7, 12}, {1e-5, 3e-5}, {-2e37, 2e37}, {0.1, 0.30000000000000004}}) {
    for (const int most : {2, 5, 8}) {
      const auto ticks = axis_ticks(lower, upper, most);
      EXPECT_GE(ticks.size(), 2U);
      EXPECT_LE(ticks.size(), static_cast<std::size_t>(most) + 1);
      for (const Tick& tick : ticks) {
        EXPECT_NEAR(lower + tick.share * (upper - lower), std::strtod(tick.label.c_str(), nullptr),
                    1e-5 * (upper - lower));
      }
    }
  }
}

TEST(AxisTicks, EndsWhereNothingRoundLiesBetween) {
  const auto ticks = axis_ticks(1, std::nextafter(1, 2), 5);
  ASSERT_EQ(ticks.size(), 2U);
  EXPECT_EQ(ticks[0].share, 0);
  EXPECT_EQ(ticks[1].share, 1);
  EXPECT_EQ(axis_ticks(0, 5e-324, 5).size(), 2U);
}

TEST(CountTicks, ArePowersOfTen) {
  EXPECT_EQ(labels(count_ticks(5000, 10)), "1 10 100 1000");
  EXPECT_EQ(labels(count_ticks(1e6, 10)), "1 10 100 1000 10000 1e5 1e6");
  EXPECT_EQ(labels(count_ticks(1e6, 3)), "1 1000 1e6");
  EXPECT_EQ(labels(count_ticks(1, 10)), "1");
  for (const Tick& tick : count_ticks(1e6, 10)) {
    EXPECT_NEAR(tick.share, std::log1p(std::strtod(tick.label.c_str(), nullptr)) / std::log1p(1e6),
                1e-12);
  }
  EXPECT_EQ(count_share(0, 7), 0);
  EXPECT_EQ(count_share(7, 7), 1);
}

}  // namespace
