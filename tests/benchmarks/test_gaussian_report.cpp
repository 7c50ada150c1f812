// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "benchmarks/frames/pellucid_contenders.h"
#include "benchmarks/gaussians/gaussian_report.h"

namespace pellucid::bench::test_gaussian_report {
namespace {

/// Exact takes a second to every error; midpoint `seconds` to an error of `reached`.
SceneResult result(double seconds, double reached) {
  SceneResult r;
  r.curves = {{exact_name, Knob::tolerance, {{1e-4, {1.0}, {1e-5, 1e-6}, 0}}, false},
              {"midpoint", Knob::step, {{1, {seconds}, {reached, reached}, 0}}, false}};
  return r;
}

TEST(GaussianReport, ComparesAtAnEqualError) {
  const TimeRatio ratio = sampler_over_exact(result(3, 1e-3), 1e-2);
  EXPECT_TRUE(ratio.known);
  EXPECT_FALSE(ratio.at_least);
  EXPECT_DOUBLE_EQ(ratio.value, 3);
  EXPECT_TRUE(sampler_over_exact(result(3, 1e-3), 1e-4).at_least);
  EXPECT_FALSE(sampler_over_exact(SceneResult{}, 1e-2).known);
}

TEST(GaussianReport, TellsWhereSamplingCatchesUp) {
  // To 1e-2 as long at 0.02, the mean of 0.04 and 0.01 in logarithms; to 1/512 the sampler is over
  // its time at 0.01 without having got there; to 1e-4 the wide one did not get there either, in
  // less time than exact, which says nothing.
  const Series widths{"", {{0.04, result(0.25, 1e-3)}, {0.01, result(4, 5e-3)}}};
  const std::string text = crossings(widths);
  EXPECT_NE(text.find("To 1e-2: both take as long at a width of about 0.02."), std::string::npos)
      << text;
  EXPECT_NE(text.find("To 1/512: sampling is the faster one at a width of 0.04, exact at 0.01."),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("To 1e-4: exact is the faster one from a width of 0.01 on."),
            std::string::npos)
      << text;
}

TEST(GaussianReport, PutsSeriesSideBySide) {
  const std::vector<Series> list{{"apart", {{1, result(2, 1e-3)}}},
                                 {"together", {{1, result(2, 1e-1)}}}};
  const std::string table = counts_table("primitives", list, 1.0 / 512);
  EXPECT_NE(table.find("| 1 | 1000 ms | 2000 ms | 1000 ms | > 2000 ms |"), std::string::npos)
      << table;
  EXPECT_EQ(counts_plot("primitives", list, 1.0 / 512).lines.size(), 4U);
}

}  // namespace
}  // namespace pellucid::bench::test_gaussian_report
