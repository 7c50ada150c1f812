// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "benchmarks/frames/pellucid_contenders.h"
#include "benchmarks/frames/report.h"

namespace pellucid::bench::test_report {
namespace {

SceneResult scene() {
  SceneResult result{"spike, oblique", {512, 512}, "256×256×256 f32", 2048, {}, {}};
  result.curves = {{exact_name,
                    Knob::tolerance,
                    {{1e-2, {0.02}, {8e-3, 1e-3}, 5},
                     {1.0 / 512, {0.04}, {1e-3, 1e-4}, 6},
                     {1e-4, {0.08}, {5e-5, 1e-5}, 7}},
                    false},
                   {"midpoint",
                    Knob::step,
                    {{1, {0.1}, {0.3, 0.1}, 1}, {0.1, {1}, {1.0 / 512, 1e-3}, 10}},
                    true},
                   {"VTK fixed point",
                    Knob::step,
                    {{1, {0.12}, {0.4, 7e-2}, 0}, {0.1, {0.6}, {0.5, 8e-2}, 0}},
                    false},
                   {"VTK smart", Knob::step, {{0.5, {0.4}, {0.2, 5e-2}, 0}}, false}};
  return result;
}

TEST(Report, TellsTheRatioToTheBestSampler) {
  const std::string table = equal_error_table({scene()});
  // At 1e-2 exact needs its first point, 20 ms; midpoint lies between its two, at 474 ms.
  EXPECT_NE(table.find("| 20 ms at 1e-2 | **24×** midpoint 0.21 |"), std::string::npos) << table;
  // At 1e-4 exact lies between two, at 68 ms; midpoint was not tried that fine, and 1 s is 15
  // times.
  EXPECT_NE(table.find("| **> 15×**: 2.0e-03 midpoint 0.1 |"), std::string::npos) << table;
}

TEST(Report, ComparesVtkWithExactToTheSameTolerance) {
  const std::string table = vtk_table({scene()});
  EXPECT_NE(table.find("3×, 120 ms (7.0e-02 / 4.0e-01)"), std::string::npos) << table;
  EXPECT_NE(table.find("10×, 400 ms"), std::string::npos) << table;
}

TEST(Report, WithoutVtkThereIsNoTableOfIt) {
  SceneResult result = scene();
  result.curves.resize(2);
  EXPECT_EQ(vtk_table({result}), "");
}

TEST(Report, QuotesOpenVklForItsScenesAlone) {
  EXPECT_NE(open_vkl_table({scene()}).find("8.9×, 355 ms (3.2e-01)"), std::string::npos);
  SceneResult other = scene();
  other.name = "engine, outside";
  EXPECT_EQ(open_vkl_table({other}), "");
}

TEST(Report, JsonHoldsEveryPoint) {
  const nlohmann::ordered_json json = frames_json({scene()});
  ASSERT_EQ(json.size(), 1U);
  const auto& curves = json[0]["curves"];
  ASSERT_EQ(curves.size(), 4U);
  EXPECT_EQ(curves[0]["points"].size(), 3U);
  EXPECT_DOUBLE_EQ(curves[0]["points"][1]["tolerance"].get<double>(), 1.0 / 512);
  EXPECT_DOUBLE_EQ(curves[1]["points"][1]["step"].get<double>(), 0.1);
  EXPECT_EQ(curves[1]["cut_short"], true);
}

TEST(Report, PlotsHaveNamesThatFilesCanHave) {
  EXPECT_EQ(plot_file(scene(), 2), "spike-oblique-2.svg");
  const Plot plot = time_error_plot(scene(), 2);
  EXPECT_EQ(plot.lines.size(), 4U);
  EXPECT_DOUBLE_EQ(plot.lines[0].points[0].x, 20);
  EXPECT_DOUBLE_EQ(plot.lines[0].points[0].y, 8e-3);
}

TEST(Report, ErrorsAreWrittenShort) {
  EXPECT_EQ(error_name(1.0 / 512), "1/512");
  EXPECT_EQ(error_name(1e-4), "1e-4");
}

}  // namespace
}  // namespace pellucid::bench::test_report
