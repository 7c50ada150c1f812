// SPDX-License-Identifier: Apache-2.0
#include "render/tolerance.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>

namespace {

using pellucid::Integration;
using pellucid::Precision;
using pellucid::RenderReport;
using pellucid::cli::over_tolerance;
using pellucid::cli::share_text;

RenderReport report_of(std::uint64_t over, double largest_error) {
  RenderReport report;
  report.pixels = 4096;
  report.pixels_over_tolerance = over;
  report.largest_error = largest_error;
  return report;
}

TEST(OverTolerance, OnlyWherePixelsAreOver) {
  EXPECT_FALSE(over_tolerance(report_of(0, 1e-3), {}).has_value());
  // What decides is the count: the largest error alone was rounded on its way.
  EXPECT_FALSE(over_tolerance(report_of(0, 1), {}).has_value());
  EXPECT_TRUE(over_tolerance(report_of(1, 1e-3), {}).has_value());
}

TEST(OverTolerance, SaysHowManyHowMuchAndWhatToDo) {
  Integration integration;
  integration.tolerance = 1e-5;
  const std::string text = *over_tolerance(report_of(12, 3.41e-5), integration);
  for (const char* part : {"12 of 4096 pixels", "1e-05", "3.41e-05", "--tolerance 3.5e-05"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " in: " << text;
  }
  EXPECT_EQ(text.find('\n'), std::string::npos);

  integration.precision = Precision::float32;
  EXPECT_NE(over_tolerance(report_of(12, 3.41e-5), integration)->find("--precision automatic"),
            std::string::npos);
}

TEST(OverTolerance, UnknownErrorsGetNoAdviceThatCannotBeTaken) {
  for (const double unknown : {std::numeric_limits<double>::infinity(),
                               std::numeric_limits<double>::quiet_NaN(), 1.0, 25.0}) {
    const std::string text = *over_tolerance(report_of(3, unknown), {});
    EXPECT_EQ(text.find("--tolerance"), std::string::npos) << text;
    EXPECT_NE(text.find("--error-map"), std::string::npos) << text;
  }
}

// A tolerance that is advised must not be below the error that was found.
TEST(OverTolerance, AdviceIsRoundedUpwards) {
  const std::string option = "--tolerance ";
  for (double error = 1.0001e-7; error < 0.99; error *= 1.37) {
    const std::string text = *over_tolerance(report_of(1, error), {});
    const std::size_t at = text.find(option);
    ASSERT_NE(at, std::string::npos) << text;
    const double advised = std::strtod(text.c_str() + at + option.size(), nullptr);
    EXPECT_GE(advised, error);
    EXPECT_LE(advised, error * 1.11);
  }
}

TEST(ShareText, IsAllOrNoneOnlyWhereItIs) {
  constexpr std::uint64_t many = 10'000'000'000;
  EXPECT_EQ(share_text(many, many), "all");
  EXPECT_EQ(share_text(0, many), "none");
  EXPECT_EQ(share_text(many - 1, many), "99.9 %");
  EXPECT_EQ(share_text(1, many), "0.1 %");
  EXPECT_EQ(share_text(1, 3), "33.3 %");
  EXPECT_EQ(share_text(0, 0), "all");
}

}  // namespace
