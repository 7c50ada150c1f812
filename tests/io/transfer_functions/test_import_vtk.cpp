// SPDX-License-Identifier: Apache-2.0

// Imported color maps and volume properties against VTK itself: transfer_functions/vtk_values.csv
// holds what vtkColorTransferFunction and vtkPiecewiseFunction give
// (tools/reference/vtk_transfer_functions.py).

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "pellucid/io/import_transfer_function.h"
#include "pellucid/scene/srgb.h"
#include "tests/io/scratch_folder.h"
#include "tests/support/accuracy.h"
#include "tests/support/table.h"

namespace pellucid::test_import_vtk {
namespace {

const std::filesystem::path folder =
    std::filesystem::path(PELLUCID_SOURCE_DIR) / "tests" / "io" / "transfer_functions";

/// Between its points, as scene.md says.
OpacityPoint at(const OpacityTable& table, double value) {
  const std::vector<OpacityPoint>& points = table.points;
  if (value <= points.front().value) return points.front();
  if (value >= points.back().value) return points.back();
  const auto after = std::upper_bound(points.begin(), points.end(), value,
                                      [](double v, const OpacityPoint& p) { return v < p.value; });
  const OpacityPoint &a = *(after - 1), &b = *after;
  const double s = (value - a.value) / (b.value - a.value);
  const auto mix = [s](double x, double y) { return (1 - s) * x + s * y; };
  return {value,
          mix(a.opacity, b.opacity),
          {mix(a.color.r, b.color.r), mix(a.color.g, b.color.g), mix(a.color.b, b.color.b)}};
}

double depth(double opacity) {
  return -std::log1p(-opacity);
}

class ImportOfVtk : public ::testing::TestWithParam<double> {};

TEST_P(ImportOfVtk, IsWhatVtkShowsToWithinTheStatedDeviation) {
  ImportOptions options;
  options.deviation = GetParam();
  const test::Table truth = test::Table::read((folder / "vtk_values.csv").string());
  for (const ColorEncoding numbers : {ColorEncoding::srgb, ColorEncoding::linear}) {
    options.encoding = numbers;
    std::map<std::string, ImportedTransferFunction> imported;
    test::ErrorRecord colors("colors", "of the deviation"), depths("depths", "of the deviation");
    for (std::size_t row = 0; row < truth.rows(); ++row) {
      const std::string name(truth.text(row, "case"));
      if (!imported.contains(name)) {
        imported[name] = import_transfer_function(folder / (name + ".json"), options);
        EXPECT_LE(imported[name].table.color_deviation, options.deviation + 1.3e-6) << name;
        EXPECT_LE(imported[name].table.extinction_deviation, options.deviation + 1e-13) << name;
      }
      const OpacityTable& table = imported[name].table;
      const auto number = [&](const char* column) {
        return static_cast<double>(truth.wide(row, column));
      };
      const OpacityPoint ours = at(table, number("value"));
      const Rgb<double> shown{number("r"), number("g"), number("b")};
      const Rgb<double> color = numbers == ColorEncoding::srgb ? srgb_to_linear(shown) : shown;
      const double off = largest_component(ours.color - color);
      // Rounding of VTK's own, 1e-15, is not charged.
      colors.add(off / (table.color_deviation + 1e-14), name);
      const double opacity = number("opacity");
      if (opacity == 0) {
        EXPECT_EQ(ours.opacity, 0) << name;
        continue;
      }
      depths.add(std::abs(std::log(depth(ours.opacity) / depth(opacity))) /
                     (table.extinction_deviation + 1e-13),
                 name);
    }
    colors.print();
    depths.print();
    EXPECT_LE(colors.largest(), 1);
    EXPECT_LE(depths.largest(), 1);
    EXPECT_EQ(imported.size(), 16u);
  }
}

INSTANTIATE_TEST_SUITE_P(Deviations, ImportOfVtk, ::testing::Values(0.05, 1e-3, 1e-5));

TEST(ImportOfVtkNotes, SayWhatIsExact) {
  const auto deviations = [](const std::string& name, ColorEncoding numbers) {
    ImportOptions options;
    options.encoding = numbers;
    const OpacityTable table = import_transfer_function(folder / (name + ".json"), options).table;
    return std::pair(table.color_deviation > 0, table.extinction_deviation > 0);
  };
  using Fitted = std::pair<bool, bool>;
  EXPECT_EQ(deviations("rgb", ColorEncoding::linear), Fitted(false, false));
  EXPECT_EQ(deviations("rgb", ColorEncoding::srgb), Fitted(true, false));
  EXPECT_EQ(deviations("step", ColorEncoding::srgb), Fitted(false, false));
  EXPECT_EQ(deviations("slicer", ColorEncoding::linear), Fitted(false, false));
  EXPECT_EQ(deviations("slicer_hermite", ColorEncoding::linear), Fitted(true, true));
  EXPECT_EQ(deviations("lab", ColorEncoding::linear), Fitted(true, false));
}

}  // namespace
}  // namespace pellucid::test_import_vtk
