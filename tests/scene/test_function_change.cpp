// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <vector>

#include "expect_error.h"
#include "pellucid/scene/function_change.h"

namespace pellucid::test_function_change {
namespace {

/// A cube of 10³ values 0 to 999.
Volume counted() {
  Volume::Description description;
  description.dimensions = {10, 10, 10};
  std::vector<float> values;
  for (int i = 0; i < 1000; ++i) values.push_back(static_cast<float>(i));
  return Volume(description, VolumeData(values));
}

TransferFunction ramp() {
  return TransferFunction({{0, 0, {1, 0, 0}}, {10, 4, {0, 1, 0}}});
}

TEST(FunctionChange, PercentagesAreOfTheValues) {
  const Volume volume = counted();
  using Range = std::array<double, 2>;
  EXPECT_EQ(value_range({{{5, false}, {7, false}}}, volume), (Range{5, 7}));
  const Range range = value_range({{{10, true}, {75, true}}}, volume);
  EXPECT_NEAR(range[0], 100, 1);
  EXPECT_NEAR(range[1], 750, 1);
  EXPECT_EQ(value_range({{{0, true}, {500, false}}}, volume)[1], 500);
  expect_error(
      [&] {
        value_range({{{50, true}, {3, false}}}, volume);
      },
      {"range: got 50% to 3, which is 500 to 3, but expected two ascending values"});
  expect_error([&] { value_range({{{50, true}, {101, true}}}, volume); }, {"from 0% to 100%"});
}

TEST(FunctionChange, MovesColorsAndMultiplies) {
  FunctionChange change;
  EXPECT_TRUE(change.is_none());
  change.colors = color_map("viridis");
  change.range = RangeEnds{{{20, true}, {80, true}}};
  change.opacity = 3;
  const TransferFunction made = changed(ramp(), change, counted());
  const auto& points = made.points();
  EXPECT_EQ(points.size(), color_map("viridis").size());
  EXPECT_NEAR(points.front().value, 200, 1);
  EXPECT_NEAR(points.back().value, 799, 1);
  EXPECT_EQ(points.back().extinction, 12);
  EXPECT_EQ(points.front().color, color_map("viridis").front().color);
  EXPECT_EQ(points.back().color, color_map("viridis").back().color);
}

TEST(FunctionChange, WithoutARangeColorsWhatAbsorbs) {
  FunctionChange change;
  change.colors = color_map("viridis");
  const TransferFunction bump({{0, 0, {}}, {2, 0, {}}, {3, 1, {}}, {4, 0, {}}, {9, 0, {}}});
  const TransferFunction made = changed(bump, change, counted());
  EXPECT_EQ(made.view<double>().evaluate(1).color, color_map("viridis").front().color);
  EXPECT_EQ(made.view<double>().evaluate(4).color, color_map("viridis").back().color);
}

TEST(FunctionChange, KeepsOpacitiesOfATable) {
  FunctionChange change;
  change.colors = color_map("grey");
  const std::vector<OpacityPoint> table{{0, 0, {1, 0, 0}}, {10, 1, {1, 0, 0}}};
  const auto made = changed(table, change, {{100.0, 300.0}});
  EXPECT_EQ(made.front().value, 100);
  EXPECT_EQ(made.back().value, 300);
  EXPECT_EQ(made.back().opacity, 1);
  for (const OpacityPoint& point : made) {
    EXPECT_NEAR(point.opacity, (point.value - 100) / 200, 1e-12);
  }
}

TEST(FunctionChange, ChangesSurfacesAsPoints) {
  std::vector<Isosurface> surfaces(3);
  for (std::size_t i = 0; i < 3; ++i) {
    surfaces[i].value = std::array{2.0, 3.0, 6.0}[i];
    surfaces[i].opacity = 0.5;
    surfaces[i].color = {0.1, 0.2, 0.3};
  }
  FunctionChange change;
  change.opacity = 2;
  auto made = changed(surfaces, change, std::nullopt);
  EXPECT_EQ(made[1].value, 3);
  EXPECT_EQ(made[1].opacity, 0.75);
  EXPECT_EQ(made[1].color, surfaces[1].color);
  change.colors = color_map("grey");
  change.opacity = 1;
  made = changed(surfaces, change, std::array{10.0, 50.0});
  EXPECT_NEAR(made[0].value, 14, 1e-12);
  EXPECT_NEAR(made[1].value, 22, 1e-12);
  EXPECT_NEAR(made[2].value, 46, 1e-12);
  EXPECT_EQ(made[0].color, color_at(change.colors, 0.1));
  EXPECT_EQ(made[1].opacity, 0.5);
  change.opacity = 0.5;
  made = changed(surfaces, change, std::nullopt);
  EXPECT_EQ(made[0].color, (Rgb<double>{0, 0, 0}));
  EXPECT_EQ(made[2].color, (Rgb<double>{1, 1, 1}));
  EXPECT_EQ(made[1].opacity, 0.25);
  EXPECT_TRUE(changed(std::vector<Isosurface>(), change, std::nullopt).empty());
}

}  // namespace
}  // namespace pellucid::test_function_change
