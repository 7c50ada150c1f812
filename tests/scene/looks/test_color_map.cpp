// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include "pellucid/scene/color_map.h"
#include "pellucid/scene/srgb.h"
#include "tests/scene/expect_error.h"

namespace pellucid::test_color_map {
namespace {

double difference(const Rgb<double>& a, const Rgb<double>& b) {
  return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

// The file is made from matplotlib, VTK and GMT, at positions between the points too.
TEST(ColorMap, IsWithinOneStepOfItsSource) {
  std::ifstream file(PELLUCID_SOURCE_DIR "/tests/scene/color_maps.csv");
  std::string line;
  std::getline(file, line);
  std::set<std::string> seen;
  int count = 0;
  while (std::getline(file, line)) {
    std::istringstream fields(line);
    std::string name, number;
    std::getline(fields, name, ',');
    double numbers[4];
    for (double& value : numbers) {
      std::getline(fields, number, ',');
      value = std::stod(number);
    }
    const Rgb<double> source{numbers[1], numbers[2], numbers[3]};
    const Rgb<double> ours = 255.0 * linear_to_srgb(color_at(color_map(name), numbers[0]));
    EXPECT_LT(difference(ours, source), 1) << line;
    seen.insert(name);
    ++count;
  }
  EXPECT_EQ(seen.size(), 13u);
  EXPECT_GT(count, 400);
}

TEST(ColorMap, AllAreFromZeroToOneAndAscend) {
  const auto names = color_map_names();
  EXPECT_GT(names.size(), 40u);
  for (const std::string& name : names) {
    const ColorMap map = color_map(name);
    EXPECT_LE(map.size(), 70u) << name;
    EXPECT_EQ(map.front().position, 0) << name;
    EXPECT_EQ(map.back().position, 1) << name;
    for (std::size_t i = 0; i < map.size(); ++i) {
      EXPECT_LE(largest_component(map[i].color), 1) << name;
      if (i == 0) continue;
      EXPECT_LT(map[i - 1].position, map[i].position) << name;
    }
    EXPECT_TRUE(is_color_map(name));
  }
}

TEST(ColorMap, IsFoundHoweverItIsWritten) {
  const ColorMap map = color_map("cool to warm (extended)");
  for (const char* name : {"Cool to Warm (Extended)", "cool-to-warm-extended", "COOLTOWARMEXTENDED",
                           "cool_to_warm_extended"}) {
    const ColorMap found = color_map(name);
    ASSERT_EQ(found.size(), map.size()) << name;
    EXPECT_EQ(difference(found[3].color, map[3].color), 0) << name;
  }
  EXPECT_EQ(difference(color_at(color_map("gray"), 0.3), color_at(color_map("Grey"), 0.3)), 0);
  EXPECT_GT(difference(color_at(color_map("coolwarm"), 0), color_at(color_map("cool to warm"), 1)),
            0.1);
}

TEST(ColorMap, IsReversedByItsName) {
  const ColorMap map = color_map("inferno"), backwards = color_map("Inferno_r");
  EXPECT_EQ(backwards.front().position, 0);
  EXPECT_EQ(backwards.back().position, 1);
  for (const double x : {0.0, 0.1, 0.37, 0.5, 1.0}) {
    EXPECT_LT(difference(color_at(map, x), color_at(backwards, 1 - x)), 1e-12) << x;
  }
}

TEST(ColorMap, OfUnknownNameTellsThoseThatAreNear) {
  EXPECT_TRUE(is_color_map("Viridis_r"));
  EXPECT_FALSE(is_color_map("virdis"));
  EXPECT_FALSE(is_color_map("_r"));
  expect_error([] { color_map("virdis"); },
               {"color map: there is none of the name \"virdis\"; did you mean viridis, "});
  expect_error([] { color_map("qqq"); }, {"there are viridis, plasma,"});
}

TransferFunction tent() {
  return TransferFunction(
      {{-10, 0, {}}, {0, 0, {}}, {4, 2, {1, 0, 0}}, {4, 3, {}}, {8, 0, {}}, {20, 0, {}}});
}

TEST(Recolored, KeepsExtinctionsAndHasTheMapBetweenItsPoints) {
  const ColorMap map = color_map("viridis");
  const TransferFunction function = with_colors(tent(), map, {0, 8});
  const auto view = function.view<double>();
  EXPECT_EQ(function.points().size(), tent().points().size() + map.size() - 2);
  const TransferFunction before = tent();
  for (double value = -12; value < 22; value += 0.37) {
    const auto now = view.evaluate(value);
    EXPECT_NEAR(now.extinction, before.view<double>().evaluate(value).extinction, 1e-12) << value;
    EXPECT_LT(difference(now.color, color_at(map, value / 8)), 1e-12) << value;
  }
}

TEST(Recolored, RangeIsWhereAFunctionAbsorbs) {
  EXPECT_EQ(absorbing_range(tent()), (std::array<double, 2>{0, 8}));
  EXPECT_EQ(absorbing_range(TransferFunction({{1, 0, {}}, {3, 0, {}}})),
            (std::array<double, 2>{1, 3}));
  EXPECT_EQ(absorbing_range(TransferFunction({{1, 2, {}}, {3, 2, {}}})),
            (std::array<double, 2>{1, 3}));
  const auto one = absorbing_range(TransferFunction({{100, 2, {}}}));
  EXPECT_EQ(one, (std::array<double, 2>{75, 125}));
}

TEST(Recolored, MovesAFunctionToARange) {
  const auto points = moved_to_range(tent(), {100, 400}).points();
  ASSERT_EQ(points.size(), 6u);
  EXPECT_EQ(points.front().value, 100);
  EXPECT_EQ(points[1].value, 200);
  EXPECT_NEAR(points[2].value, 240, 1e-9);
  EXPECT_EQ(points[2].value, points[3].value);
  EXPECT_EQ(points.back().value, 400);
  const double next = std::nextafter(1.0, 2.0);
  EXPECT_LE(moved_to_range(tent(), {1, next}).points().size(), 4u);
  EXPECT_EQ(moved_to_range(TransferFunction({{5, 2, {}}}), {1, 2}).points().back().extinction, 2);
  EXPECT_EQ(moved_to_range(tent(), {-2.1e37, 2.1e37}).points().back().value, 2.1e37);
  expect_error([] { moved_to_range(tent(), {2, 2}); }, {"range: got 2 to 2, but expected"});
}

TEST(Recolored, HasExtinctionsTimesAFactor) {
  EXPECT_EQ(with_opacity(tent(), 2.5).points()[3].extinction, 7.5);
  EXPECT_EQ(with_opacity(tent(), 0).points()[3].extinction, 0);
  expect_error([] { with_opacity(tent(), -1); }, {"opacity: got a factor of -1"});
  expect_error([] { with_opacity(tent(), 1e30); }, {"makes an extinction of 2e+30"});
}

}  // namespace
}  // namespace pellucid::test_color_map
