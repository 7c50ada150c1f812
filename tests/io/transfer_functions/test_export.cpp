// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "pellucid/io/export_transfer_function.h"
#include "pellucid/io/import_transfer_function.h"
#include "tests/io/scratch_folder.h"

namespace pellucid::test_export {
namespace {

struct Look {
  double depth = 0;  ///< per world length
  Rgb<double> color{};
};

template <class Point, class Depth>
Look look(const std::vector<Point>& points, double value, Depth&& depth) {
  if (value <= points.front().value)
    return {depth(points.front(), points.front(), 0.0), points.front().color};
  if (value >= points.back().value)
    return {depth(points.back(), points.back(), 0.0), points.back().color};
  const auto after = std::upper_bound(points.begin(), points.end(), value,
                                      [](double v, const Point& p) { return v < p.value; });
  const Point &a = *(after - 1), &b = *after;
  const double s = (value - a.value) / (b.value - a.value);
  return {depth(a, b, s), a.color + (b.color - a.color) * s};
}

Look look(const OpacityTable& table, double value) {
  return look(table.points, value, [&](const OpacityPoint& a, const OpacityPoint& b, double s) {
    return -std::log1p(-(a.opacity + s * (b.opacity - a.opacity))) / table.unit_distance;
  });
}
Look look(const std::vector<TransferFunction::Point>& points, double value) {
  return look(points, value,
              [](const TransferFunction::Point& a, const TransferFunction::Point& b, double s) {
                return a.extinction + s * (b.extinction - a.extinction);
              });
}

/// Exported, imported again, and compared over the range: within the sum of what both say.
template <class Function>
void expect_round_trip(const Function& function, double first, double last, double unit) {
  for (const ExportFormat format :
       {ExportFormat::slicer, ExportFormat::paraview, ExportFormat::table}) {
    ExportOptions options;
    options.format = format;
    options.deviation = 1e-3;
    const ExportedTransferFunction exported = export_transfer_function(function, options);
    EXPECT_LE(exported.color_deviation, 1.001e-3);
    EXPECT_LE(exported.extinction_deviation, 1e-3);
    ImportOptions import;
    if (format != ExportFormat::slicer) import.unit_distance = unit;
    const OpacityTable back = import_transfer_function(exported.text, "back", import).table;
    EXPECT_EQ(back.unit_distance, unit);
    const double color = exported.color_deviation + back.color_deviation + 1e-12;
    const double depth = exported.extinction_deviation + back.extinction_deviation + 1e-9;
    for (int i = -10; i <= 1010; ++i) {
      const double value = first + (last - first) * (i + 0.37) / 1000;
      const Look ours = look(function, value), theirs = look(back, value);
      EXPECT_LE(largest_component(ours.color - theirs.color), color) << value;
      if (ours.depth == 0) {
        EXPECT_EQ(theirs.depth, 0) << value;
      } else {
        EXPECT_LE(std::abs(std::log(theirs.depth / ours.depth)), depth) << value;
      }
    }
  }
}

TEST(Export, ComesBackWithinWhatIsSaid) {
  expect_round_trip(std::vector<TransferFunction::Point>{{-5, 0, {0, 0, 0}},
                                                         {0, 0, {0.001, 0.4, 1}},
                                                         {3, 2.5, {1, 0.2, 0}},
                                                         {3, 0.25, {0, 1, 0}},
                                                         {10, 6, {0.9, 0.8, 0.7}}},
                    -5, 10, 1);
  expect_round_trip(
      OpacityTable{{{0, 0, {0.5, 0.5, 0.5}}, {1, 0.3, {0.1, 0.9, 0}}, {2, 0.95, {1, 1, 1}}}, 0.5},
      0, 2, 0.5);
}

TEST(Export, OpacityTablesKeepTheirOpacities) {
  const OpacityTable table{{{0, 0.125, {0.25, 0.25, 0.25}}, {1, 0.5, {0.25, 0.25, 0.25}}}, 2};
  const ExportedTransferFunction exported =
      export_transfer_function(table, {ExportFormat::table, 1e-3});
  EXPECT_EQ(exported.extinction_deviation, 0);
  EXPECT_EQ(exported.color_deviation, 0);
  EXPECT_EQ(std::count(exported.text.begin(), exported.text.end(), '\n'), 3);
  EXPECT_EQ(exported.text.rfind("value,r,g,b,a\n0,", 0), 0u);
}

TEST(Export, SlicerHoldsShadingAndGradientOpacity) {
  LookDescription look;
  look.transfer_function = OpacityTable{{{0, 0, {0, 0, 0}}, {1, 0.5, {1, 1, 1}}}, 2};
  look.shading.emplace().ambient = 0.125;
  look.shading->power = 7;
  const auto factors = [](std::vector<GradientOpacity::Point> points, GradientOpacity::Unit unit) {
    return std::make_shared<const GradientOpacity>(std::move(points), unit);
  };
  look.gradient_opacity = factors({{0, 0.25}, {10, 0.5}, {10, 1}}, GradientOpacity::Unit::voxel);
  const auto has = [](const std::vector<std::string>& notes, const std::string& part) {
    return std::ranges::any_of(notes,
                               [&](const std::string& note) { return test::contains(note, part); });
  };
  const ExportedTransferFunction exported = export_transfer_function(look, {});
  EXPECT_TRUE(has(exported.notes, "gradient opacity: exact"));
  EXPECT_TRUE(has(exported.notes, "flatness and the kind of gradient"));
  const ImportedTransferFunction back = import_transfer_function(exported.text, "back");
  EXPECT_EQ(back.shading, look.shading);
  ASSERT_TRUE(back.gradient_opacity);
  const std::vector<GradientOpacity::Point>& read = back.gradient_opacity->points();
  ASSERT_EQ(read.size(), 3u);
  EXPECT_EQ(back.gradient_opacity->unit(), GradientOpacity::Unit::voxel);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(read[i].gradient, look.gradient_opacity->points()[i].gradient);
    EXPECT_EQ(read[i].factor, look.gradient_opacity->points()[i].factor);
  }
  for (const ExportFormat format : {ExportFormat::paraview, ExportFormat::table}) {
    ExportOptions options;
    options.format = format;
    const auto notes = export_transfer_function(look, options).notes;
    EXPECT_TRUE(has(notes, "the shading is left out"));
    EXPECT_TRUE(has(notes, "the gradient opacity is left out"));
  }
  look.gradient_opacity = factors({{0, 0.25}}, GradientOpacity::Unit::world);
  EXPECT_TRUE(has(export_transfer_function(look, {}).notes, "per world length"));
  look.gradient_opacity = factors({{0, 2}}, GradientOpacity::Unit::voxel);
  EXPECT_TRUE(has(export_transfer_function(look, {}).notes, "factors above 1"));
}

TEST(Export, RefusesWhatHasNoCounterpart) {
  const auto error = [](const TransferFunctionDescription& function) {
    return test::error_of([&] { export_transfer_function(function, {}); });
  };
  EXPECT_TRUE(test::contains(error(MultivariateDescription{}), "several channels"));
  EXPECT_TRUE(test::contains(error(PresetDescription{"x-ray", {}}), "preset"));
  EXPECT_TRUE(test::contains(error(std::vector<TransferFunction::Point>{{0, 1, {0, 1.5, 0}}}),
                             "the color of point 0 is above 1"));
  EXPECT_TRUE(test::contains(error(std::vector<TransferFunction::Point>{}), "no points"));
}

}  // namespace
}  // namespace pellucid::test_export
