// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "benchmarks/support/plot.h"

namespace pellucid::bench::test_plot {
namespace {

struct Place {
  double x, y;
};
/// Where the markers of the first line (circles) are; the last one stands in the legend.
std::vector<Place> circles(const std::string& svg) {
  std::vector<Place> list;
  const std::regex pattern("<circle cx=\"([0-9.]+)\" cy=\"([0-9.]+)\"");
  for (std::sregex_iterator it(svg.begin(), svg.end(), pattern), end; it != end; ++it) {
    list.push_back({std::stod((*it)[1]), std::stod((*it)[2])});
  }
  return list;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

TEST(Plot, DecadesAreEquallyFarApartAndErrorsFallDownwards) {
  Plot plot;
  plot.lines.push_back({"exact", {{1, 1, ""}, {10, 1e-1, ""}, {100, 1e-2, ""}}});
  const std::vector<Place> at = circles(to_svg(plot));
  ASSERT_EQ(at.size(), 4U);
  EXPECT_NEAR(at[1].x - at[0].x, at[2].x - at[1].x, 0.11);
  EXPECT_NEAR(at[1].y - at[0].y, at[2].y - at[1].y, 0.11);
  EXPECT_GT(at[1].x, at[0].x);
  EXPECT_GT(at[1].y, at[0].y);
}

TEST(Plot, WhatHasNoLogarithmIsNotDrawn) {
  Plot plot;
  plot.lines.push_back(
      {"exact", {{1, 1, ""}, {10, 0, ""}, {0, 1, ""}, {1, INFINITY, ""}, {1, NAN, ""}}});
  const std::string svg = to_svg(plot);
  EXPECT_EQ(circles(svg).size(), 2U);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

TEST(Plot, AnEmptyOneIsStillAPicture) {
  EXPECT_TRUE(to_svg({}).ends_with("</svg>\n"));
}

TEST(Plot, LabelsNeverLieOnEachOther) {
  Plot plot;
  plot.lines.push_back({"exact", {}});
  for (int i = 0; i < 30; ++i) plot.lines[0].points.push_back({30 + 1e-3 * i, 0.03, "label"});
  plot.lines[0].points.push_back({400, 0.004, "alone"});
  const std::string svg = to_svg(plot);
  EXPECT_EQ(count(svg, ">alone<"), 1U);
  // Thirty markers in one place: one label on each side of them and at two corners at most.
  EXPECT_GE(count(svg, ">label<"), 1U);
  EXPECT_LE(count(svg, ">label<"), 6U);
}

TEST(Plot, TextIsEscaped) {
  Plot plot;
  plot.title = "a < b & c > d";
  const std::string svg = to_svg(plot);
  EXPECT_NE(svg.find("a &lt; b &amp; c &gt; d"), std::string::npos);
}

TEST(Plot, MarksAreDrawnOnlyInside) {
  Plot plot;
  plot.lines.push_back({"exact", {{1, 1, ""}, {10, 1e-2, ""}}});
  plot.marks = {{0.1, "inside"}, {1e-5, "below"}};
  const std::string svg = to_svg(plot);
  EXPECT_EQ(count(svg, ">inside<"), 1U);
  EXPECT_EQ(count(svg, ">below<"), 0U);
}

}  // namespace
}  // namespace pellucid::bench::test_plot
