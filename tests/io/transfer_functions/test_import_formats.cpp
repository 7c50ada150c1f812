// SPDX-License-Identifier: Apache-2.0

// The formats that are no VTK of ours: what their formulas give, computed here from their
// definitions.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "pellucid/io/import_transfer_function.h"
#include "pellucid/io/scene_json.h"
#include "tests/io/scratch_folder.h"

namespace pellucid::test_import_formats {
namespace {

using test::contains;

ImportedTransferFunction read(const std::string& text, const ImportOptions& options = {}) {
  return import_transfer_function(text, "f", options);
}

bool has_note(const ImportedTransferFunction& imported, const std::string& part) {
  return std::any_of(imported.notes.begin(), imported.notes.end(),
                     [&](const std::string& note) { return contains(note, part); });
}

OpacityPoint at(const OpacityTable& table, double value) {
  const auto& points = table.points;
  if (value <= points.front().value) return points.front();
  if (value >= points.back().value) return points.back();
  const auto after = std::upper_bound(points.begin(), points.end(), value,
                                      [](double v, const OpacityPoint& p) { return v < p.value; });
  const OpacityPoint &a = *(after - 1), &b = *after;
  const double s = (value - a.value) / (b.value - a.value);
  return {value, a.opacity + s * (b.opacity - a.opacity), a.color + (b.color - a.color) * s};
}

/// By VisIt's and vtk.js's own steps: x is stretched about the biased top, then normalised.
double gaussian(double x, double pos, double height, double width, double x_bias, double y_bias) {
  if (x > pos + width || x < pos - width) return 0;
  double x0 = x;
  if (x_bias != 0 && x > pos + x_bias) x0 = pos + (x - pos - x_bias) * (width / (width - x_bias));
  if (x_bias != 0 && x < pos + x_bias) x0 = pos - (x - pos - x_bias) * (width / (width + x_bias));
  const double x1 = (x0 - pos) / width;
  const double h0a = std::exp(-(4 * x1 * x1)), h0b = 1 - x1 * x1;
  return height *
         (y_bias < 1 ? y_bias * h0b + (1 - y_bias) * h0a : (2 - y_bias) * h0b + (y_bias - 1));
}

void expect_depths_near(const OpacityTable& table, double value, double opacity) {
  const double ours = at(table, value).opacity;
  if (opacity == 0) {
    EXPECT_EQ(ours, 0) << value;
    return;
  }
  const double ratio = std::log1p(-ours) / std::log1p(-opacity);
  EXPECT_LE(std::abs(std::log(ratio)), table.extinction_deviation + 1e-12) << value;
}

TEST(ImportVtkJs, FollowsTheGaussians) {
  const std::string text = R"({"gaussians": [
    {"position": 0.3, "height": 0.8, "width": 0.2, "xBias": 0.1, "yBias": 0.4},
    {"position": 0.6, "height": 0.5, "width": 0.35, "xBias": -0.2, "yBias": 1.6},
    {"position": 0.9, "height": 1, "width": 0.05, "xBias": 0, "yBias": 0}],
    "mappingRange": [-100, 300]})";
  for (const double deviation : {1e-2, 1e-4}) {
    ImportOptions options;
    options.deviation = deviation;
    const ImportedTransferFunction f = read(text, options);
    EXPECT_EQ(f.format, "vtk.js Gaussians");
    EXPECT_GT(f.table.extinction_deviation, 0);
    EXPECT_LE(f.table.extinction_deviation, deviation + 1e-13);
    EXPECT_TRUE(has_note(f, "white"));
    for (int i = 0; i <= 2000; ++i) {
      const double x = (i + 0.37) / 2001;
      const double opacity =
          std::max({gaussian(x, 0.3, 0.8, 0.2, 0.1, 0.4), gaussian(x, 0.6, 0.5, 0.35, -0.2, 1.6),
                    gaussian(x, 0.9, 1, 0.05, 0, 0)});
      // Above, an opacity is known to 1e-6 only, as chord_fit.h says.
      if (opacity > 1 - 1e-6) continue;
      expect_depths_near(f.table, -100 + 400 * x, opacity);
    }
  }
}

TEST(ImportVisIt, ReadsItsAttributes) {
  const std::string text = R"(<?xml version="1.0"?>
<!-- saved -->
<Object name="VolumeAttributes">
  <Object name="ColorControlPointList">
    <Object name="ColorControlPoint">
      <Field name="colors" type="unsignedCharArray" length="4">0 0 255 255 </Field>
      <Field name="position" type="float">0</Field>
    </Object>
    <Object name="ColorControlPoint">
      <Field name="colors" type="unsignedCharArray" length="4">255 0 0 255 </Field>
      <Field name="position" type="float">1</Field>
    </Object>
  </Object>
  <Object name="GaussianControlPointList">
    <Object name="GaussianControlPoint">
      <Field name="x" type="float">0.4</Field>
      <Field name="height" type="float">0.6</Field>
      <Field name="width" type="float">0.25</Field>
      <Field name="xBias" type="float">0.05</Field>
      <Field name="yBias" type="float">0.5</Field>
    </Object>
  </Object>
</Object>
)";
  ImportOptions options;
  options.range = {{0, 10}};
  const ImportedTransferFunction f = read(text, options);
  EXPECT_EQ(f.format, "VisIt volume attributes");
  for (int i = 0; i <= 200; ++i) {
    const double x = (i + 0.37) / 201;
    expect_depths_near(f.table, 10 * x, gaussian(x, 0.4, 0.6, 0.25, 0.05, 0.5));
  }
  EXPECT_EQ(at(f.table, 0).color, (Rgb<double>{0, 0, 1}));
  EXPECT_EQ(at(f.table, 10).color, (Rgb<double>{1, 0, 0}));
}

TEST(ImportAnari, TakesColorsAsLinearAndSpreadsThem) {
  const ImportedTransferFunction f = read(R"({"color": [[1, 0, 0], [0, 0.5, 0], [0, 0, 1]],
    "opacity": [0, 0.5], "valueRange": [10, 20], "unitDistance": 0.25})");
  EXPECT_EQ(f.format, "ANARI transferFunction1D");
  EXPECT_EQ(f.table.unit_distance, 0.25);
  EXPECT_EQ(f.table.color_deviation, 0);
  EXPECT_EQ(f.table.extinction_deviation, 0);
  ASSERT_EQ(f.table.points.size(), 3u);
  EXPECT_EQ(f.table.points[1].value, 15);
  EXPECT_EQ(f.table.points[1].color, (Rgb<double>{0, 0.5, 0}));
  EXPECT_EQ(f.table.points[1].opacity, 0.25);
  EXPECT_EQ(f.table.points[2].value, 20);
  const ImportedTransferFunction placed = read(
      R"({"color": [[1, 0, 0, 0.2], [0, 0, 1, 0.4]], "color.position": [0.25, 1],
          "valueRange": [0, 4]})");
  EXPECT_EQ(placed.table.points.front().value, 1);
  EXPECT_EQ(placed.table.points.back().opacity, 0.4);
}

TEST(ImportTable, ReadsRowsOfColors) {
  ImportOptions linear;
  linear.encoding = ColorEncoding::linear;
  const OpacityTable plain = read("0,0,0\n0.5 0.25 0\n1;1;1\n", linear).table;
  ASSERT_EQ(plain.points.size(), 3u);
  EXPECT_EQ(plain.points[1].value, 0.5);
  EXPECT_EQ(plain.points[1].opacity, 0.5);  // the ramp
  EXPECT_EQ(plain.points[1].color, (Rgb<double>{0.5, 0.25, 0}));
  const OpacityTable bytes =
      read("# a map\nvalue,r,g,b,a\r\n-10,255,0,0,0\r\n30,0,0,51,128\r\n", linear).table;
  ASSERT_EQ(bytes.points.size(), 2u);
  EXPECT_EQ(bytes.points[1].value, 30);
  EXPECT_DOUBLE_EQ(bytes.points[1].color.b, 0.2);
  EXPECT_DOUBLE_EQ(bytes.points[1].opacity, 128 / 255.0);
  EXPECT_EQ(read("0.5,0.5,0.5,0.25", linear).table.points.front().opacity, 0.25);
}

TEST(ImportParaView, ReadsXmlAndMapsByName) {
  const std::string text = R"(<ColorMaps><ColorMap name="a" space="RGB">
    <Point x="0" o="0" r="1" g="0" b="0"/><Point x="2" o="1" r="0" g="0" b="1"/></ColorMap>
    <ColorMap name="b" space="Step"><Point x="0" o="0.5" r="1" g="1" b="0"/></ColorMap>
    </ColorMaps>)";
  ImportOptions options;
  options.encoding = ColorEncoding::linear;
  EXPECT_EQ(read(text, options).table.points.size(), 2u);
  EXPECT_TRUE(has_note(read(text, options), "first of 2 maps"));
  options.name = "b";
  EXPECT_EQ(read(text, options).table.points.front().color, (Rgb<double>{1, 1, 0}));
  options.name = "c";
  EXPECT_TRUE(contains(test::error_of([&] { read(text, options); }), "no color map \"c\""));
}

// Half of the way from red to magenta, whose hue is 5/6: wrapped it goes past red, else through
// yellow, green and blue.
TEST(ImportParaView, HuesWrapWhereTheMapSaysIt) {
  ImportOptions options;
  options.encoding = ColorEncoding::linear;
  const auto green = [&](const std::string& text) {
    return at(read(text, options).table, 0.5).color.g;
  };
  const auto xml = [](const std::string& space) {
    return "<ColorMap name=\"a\" space=\"" + space +
           "\"><Point x=\"0\" r=\"1\" g=\"0\" b=\"0\"/><Point x=\"1\" r=\"1\" g=\"0\" "
           "b=\"1\"/></ColorMap>";
  };
  const auto json = [](const std::string& more) {
    return R"([{"ColorSpace": "HSV", )" + more + R"("RGBPoints": [0,1,0,0, 1,1,0,1]}])";
  };
  EXPECT_GT(green(xml("HSV")), 0.9);
  EXPECT_LT(green(xml("Wrapped")), 0.01);
  EXPECT_GT(green(json("")), 0.9);
  EXPECT_TRUE(has_note(read(json("")), "HSVWrap is not said"));
  EXPECT_LT(green(json("\"HSVWrap\": 1, ")), 0.01);
  EXPECT_GT(green(json("\"HSVWrap\": 0, ")), 0.9);
}

TEST(ImportParaView, LeavesOutWhatParaViewLeavesOut) {
  const ImportedTransferFunction f =
      read(R"(<ColorMap name="a"><Point x="0" o="0.7" r="1" g="0" b="0"/>)"
           R"(<Point x="1" o="0.7" r="0" g="0" b="1"/></ColorMap>)");
  EXPECT_EQ(at(f.table, 0.5).opacity, 0.5);  // the ramp
  EXPECT_TRUE(has_note(f, "the attribute o"));
  EXPECT_TRUE(has_note(f, "a ramp from 0 to 1"));
  EXPECT_TRUE(has_note(read(R"([{"IndexedColors": [1, 0, 0], "RGBPoints": [0,1,0,0, 1,0,0,1]}])"),
                       "IndexedColors"));
}

TEST(ImportVisIt, RefusesScalingsAndSaysWhatItLeavesOut) {
  const auto visit = [](const std::string& key, const std::string& value) {
    return R"(<Object name="VolumeAttributes"><Field name=")" + key + "\" type=\"x\">" + value +
           R"(</Field><Object name="GaussianControlPoint"><Field name="x">0.4</Field>)"
           R"(<Field name="height">0.6</Field><Field name="width">0.25</Field>)"
           R"(<Field name="xBias">0</Field><Field name="yBias">0</Field></Object></Object>)";
  };
  for (const char* scaling : {"Log", "Skew", "1"}) {
    const std::string error = test::error_of([&] { read(visit("scaling", scaling)); });
    EXPECT_TRUE(contains(error, "not Linear")) << error;
  }
  EXPECT_FALSE(has_note(read(visit("scaling", "Linear")), "left out"));
  EXPECT_TRUE(has_note(read(visit("useColorVarMin", "true")), "ColorVarMin"));
  EXPECT_FALSE(has_note(read(visit("useColorVarMin", "false")), "ColorVarMin"));
  EXPECT_TRUE(has_note(read(visit("smoothing", "CubicSpline")), "smoothing"));
}

TEST(ImportTable, ReadsHeadersInLettersOfEitherCase) {
  ImportOptions linear;
  linear.encoding = ColorEncoding::linear;
  const std::string rows = "\n0.2,0.1,0.2,0.3\n0.6,1,0,0\n";
  EXPECT_EQ(at(read("Value,R,G,B" + rows, linear).table, 0.6).color, (Rgb<double>{1, 0, 0}));
  EXPECT_EQ(at(read("Red;Green;Blue;Alpha" + rows, linear).table, 1).color,
            (Rgb<double>{0.6, 1, 0}));
  for (const char* other : {"x position,R,G,B", "R,G,B,value", "hue,s,v", "r,g,b"}) {
    EXPECT_NE(test::error_of([&] { read(other + rows); }), "") << other;
  }
}

TEST(ImportSlicer, ReadsTheLegacyText) {
  const std::string text =
      "1\n1\n0.9\n0.1\n0.2\n10\n6 -100 0 50 0.25 300 0.5\n4 0 1 255 1\n"
      "8 -100 0 0 0 300 1 0.5 0.25\n";
  ImportOptions options;
  options.encoding = ColorEncoding::linear;
  const ImportedTransferFunction f = read(text, options);
  EXPECT_EQ(f.format, "3D Slicer volume property");
  EXPECT_EQ(f.table.unit_distance, 1);
  ASSERT_EQ(f.table.points.size(), 3u);
  EXPECT_EQ(f.table.points[1].opacity, 0.25);
  EXPECT_DOUBLE_EQ(f.table.points[1].color.r, 0.375);
  ASSERT_TRUE(f.shading);
  EXPECT_EQ(f.shading->diffuse, 0.9);
  EXPECT_EQ(f.shading->ambient, 0.1);
  EXPECT_EQ(f.shading->specular, 0.2);
  EXPECT_EQ(f.shading->power, 10);
  EXPECT_FALSE(f.gradient_opacity);
  EXPECT_FALSE(has_note(f, "left out"));
  std::string dented = text;
  dented.replace(dented.find("255 1"), 5, "255 0");
  const ImportedTransferFunction g = read(dented, options);
  ASSERT_TRUE(g.gradient_opacity);
  EXPECT_EQ(g.gradient_opacity->unit(), GradientOpacity::Unit::voxel);
  ASSERT_EQ(g.gradient_opacity->points().size(), 2u);
  EXPECT_EQ(g.gradient_opacity->points()[0].factor, 1);
  EXPECT_EQ(g.gradient_opacity->points()[1].gradient, 255);
  EXPECT_EQ(g.gradient_opacity->points()[1].factor, 0);
  EXPECT_TRUE(has_note(g, "gradient opacity: a factor of the extinction"));

  std::string unlit = text;
  unlit.replace(0, 4, "1\n0\n");
  EXPECT_FALSE(read(unlit, options).shading);
  std::string dull = text;
  dull.replace(dull.find("\n10\n"), 4, "\n0\n");
  EXPECT_EQ(read(dull, options).shading->power, 1);
  EXPECT_TRUE(has_note(read(dull, options), "the specular power, 0, is 1 here"));
  std::string broken = text;
  broken.replace(broken.find("0.9"), 3, "-1");
  EXPECT_TRUE(contains(test::error_of([&] { read(broken, options); }),
                       "line 3: must be a number from 0 to 1000, a part of the shading"));
}

/// A volume property with these keys in its component.
std::string slicer(const std::string& keys) {
  return R"({"volumeProperties": [{"components": [{
              "rgbTransferFunction": {"points": [{"x": 0, "color": [1, 1, 1]}]},
              "scalarOpacity": {"points": [{"x": 0, "y": 0.5}]}, )" +
         keys + "}]}]}";
}

TEST(ImportSlicer, ReadsShading) {
  const ImportedTransferFunction f =
      read(slicer(R"("shade": true, "lighting": {"diffuse": 0.9, "ambient": 0.15, "specular": 0.4,
                                                 "specularPower": 30})"));
  ASSERT_TRUE(f.shading);
  EXPECT_EQ(f.shading->ambient, 0.15);
  EXPECT_EQ(f.shading->diffuse, 0.9);
  EXPECT_EQ(f.shading->specular, 0.4);
  EXPECT_EQ(f.shading->power, 30);
  EXPECT_TRUE(has_note(f, "shading: ambient 0.15, diffuse 0.9, specular 0.4 with power 30"));
  // As vtkVolumeProperty.
  EXPECT_EQ(read(slicer(R"("shade": 1)")).shading->power, 10);
  EXPECT_FALSE(read(slicer(R"("shade": false, "lighting": {"diffuse": 0.9})")).shading);
  EXPECT_TRUE(contains(
      test::error_of([] { read(slicer(R"("shade": true, "lighting": {"diffuse": -1})")); }),
      "/lighting/diffuse: is -1"));
}

TEST(ImportSlicer, ReadsGradientOpacity) {
  const auto points = [](const std::string& nodes, const ImportOptions& options = {}) {
    const auto f = read(slicer("\"gradientOpacity\": {\"points\": [" + nodes + "]}"), options);
    return f.gradient_opacity ? f.gradient_opacity->points()
                              : std::vector<GradientOpacity::Point>();
  };
  EXPECT_TRUE(points(R"({"x": 0, "y": 1}, {"x": 255, "y": 1})").empty());
  // A midpoint is a corner, a sharpness of 1 a jump; what is below 0 never occurs.
  const auto corner = points(
      R"({"x": -10, "y": 0}, {"x": 10, "y": 0.5, "midpoint": 0.25}, {"x": 50, "y": 1,
          "midpoint": 0.5, "sharpness": 1}, {"x": 70, "y": 0.5})");
  const double expected[][2] = {{0, 0.25}, {10, 0.5}, {20, 0.75}, {50, 1},
                                {60, 1},   {60, 0.5}, {70, 0.5}};
  ASSERT_EQ(corner.size(), 7u);
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_DOUBLE_EQ(corner[i].gradient, expected[i][0]) << i;
    EXPECT_DOUBLE_EQ(corner[i].factor, expected[i][1]) << i;
  }
  // Three nodes at one gradient are a jump from the first to the last.
  EXPECT_EQ(points(R"({"x": 5, "y": 0}, {"x": 5, "y": 0.5}, {"x": 5, "y": 1})").size(), 2u);
  const auto curve = points(R"({"x": 0, "y": 0, "sharpness": 0.5}, {"x": 8, "y": 1})");
  ASSERT_GT(curve.size(), 100u);
  EXPECT_NEAR(curve[curve.size() / 2].factor, 0.5, 1e-12);

  EXPECT_FALSE(read(slicer(R"("disableGradientOpacity": true,
                              "gradientOpacity": {"points": [{"x": 0, "y": 0}]})"))
                   .gradient_opacity);
  EXPECT_TRUE(contains(test::error_of([&] { points(R"({"x": 9, "y": 0}, {"x": 1, "y": 1})"); }),
                       "lies at a smaller gradient than the one before it"));
}

TEST(ImportSlicer, ARangeMovesGradientsInProportion) {
  ImportOptions options;
  options.range = {{-10, 30}};
  const auto f = read(R"({"volumeProperties": [{"components": [{
      "scalarOpacity": {"points": [{"x": 0, "y": 0}, {"x": 10, "y": 1}]},
      "gradientOpacity": {"points": [{"x": 0, "y": 0}, {"x": 3, "y": 1}]}}]}]})",
                      options);
  EXPECT_EQ(f.gradient_opacity->points()[1].gradient, 12);
}

TEST(Import, MovesAFunctionToARange) {
  ImportOptions options;
  options.range = {{-5, 15}};
  options.unit_distance = 3;
  options.encoding = ColorEncoding::linear;
  const OpacityTable table =
      read(R"([{"RGBPoints": [0,1,0,0, 0.25,0,1,0, 1,0,0,1], "Points": [0,0,0.5,0, 1,1,0.5,0]}])",
           options)
          .table;
  ASSERT_EQ(table.points.size(), 3u);
  EXPECT_EQ(table.points[0].value, -5);
  EXPECT_EQ(table.points[1].value, 0);
  EXPECT_EQ(table.points[2].value, 15);
  EXPECT_EQ(table.unit_distance, 3);
}

TEST(Import, CountsItsDeviationsInThePixel) {
  const ImportedTransferFunction f = read(
      R"([{"RGBPoints": [0,0.1,0.2,0.9, 1,1,0.5,0], "ColorSpace": "Lab",
           "Points": [0,0.2,0.5,0.4, 1,0.4,0.5,0]}])");
  ASSERT_GT(f.table.color_deviation, 0);
  ASSERT_GT(f.table.extinction_deviation, 0);
  OpacityTable without = f.table;
  without.color_deviation = without.extinction_deviation = 0;
  const TransferFunction with = make_transfer_function(f.table, 1.0 / 512);
  const TransferFunction exact = make_transfer_function(without, 1.0 / 512);
  EXPECT_EQ(with.color_error(), f.table.color_deviation);
  EXPECT_EQ(with.relative_error(), exact.relative_error() + f.table.extinction_deviation);
  EXPECT_GE(with.approximation_error(),
            exact.approximation_error() + 0.99 * f.table.color_deviation);
  // Saved and read again, they still count.
  const auto again = parse_transfer_function(transfer_function_to_json(f.table), "t");
  EXPECT_EQ(std::get<OpacityTable>(again).color_deviation, f.table.color_deviation);
  EXPECT_EQ(std::get<OpacityTable>(again).extinction_deviation, f.table.extinction_deviation);
}

TEST(Import, TellsOtherFormatsFromOurs) {
  for (const char* own : {R"({"points": []})", R"({"gaussians": [{"center": [1]}]})",
                          R"({"transfer_function": {}})", R"({"preset": "x-ray"})", "{", ""}) {
    EXPECT_FALSE(needs_import(own)) << own;
  }
  for (const char* other :
       {R"([{"RGBPoints": []}])", R"({"volumeProperties": []})", R"({"valueRange": [0, 1]})",
        R"({"gaussians": [{"position": 1}]})", "<ColorMap>", "1,2,3", "1\n1\n"}) {
    EXPECT_TRUE(needs_import(other)) << other;
  }
}

TEST(Import, RefusesWhatIsWrongInOneLineThatNamesThePlace) {
  const auto error = [](const std::string& text) { return test::error_of([&] { read(text); }); };
  const std::pair<const char*, const char*> cases[] = {
      {"", "f: is empty"},
      {"[]", "f: has no color map"},
      {"[3]", "f: /0: must be an object"},
      {"{\"a\": 1}", "f: is no transfer function"},
      {R"([{"RGBPoints": []}])", "f: /0/RGBPoints: has 0 numbers"},
      {R"([{"RGBPoints": [0, 1, 1]}])", "f: /0/RGBPoints: has 3 numbers"},
      {R"([{"RGBPoints": [0, 1, 1, 1.5]}])", "f: /0/RGBPoints/3: is 1.5"},
      {R"([{"RGBPoints": [0, 1, 1, null]}])", "f: /0/RGBPoints/3: must be a number"},
      {R"([{"RGBPoints": [1e999, 1, 1, 1]}])", "f: line 1"},
      {R"([{"RGBPoints": [1e31, 1, 1, 1]}])", "f: /0/RGBPoints/0: is 1e+31"},
      {R"([{"RGBPoints": [1,1,1,1, 0,1,1,1]}])", "f: /0: color 1 lies at a smaller value"},
      {R"([{"RGBPoints": [0,1,1,1], "Points": [0,2,0.5,0]}])", "f: /0/Points/1: is 2"},
      {R"([{"RGBPoints": [0,1,1,1], "ColorSpace": "Lab/CIEDE2000"}])",
       "f: /0/ColorSpace: is \"Lab"},
      {R"([{"RGBPoints": [0,1,1,1], "UseLogScale": 1}])", "f: /0/UseLogScale: asks"},
      {R"([{"IndexedColors": [1, 1, 1]}])", "f: /0/IndexedColors: are colors of categories"},
      {R"({"volumeProperties": []})", "f: /volumeProperties: is empty"},
      {R"({"volumeProperties": [{}]})", "f: /volumeProperties/0/components: is missing"},
      {R"({"volumeProperties": [{"components": [{}]}]})", "has neither colors nor opacities"},
      {R"({"volumeProperties": [{"components": [{"scalarOpacity": {"points": [{"x": 0}]}}]}]})",
       "/points/0/y: is missing"},
      {R"({"volumeProperties": [{"components": [{"scalarOpacityUnitDistance": 0}]}]})",
       "/scalarOpacityUnitDistance: is 0"},
      {R"({"gaussians": [{"position": 0, "height": 2, "width": 1}]})",
       "f: /gaussians/0/height: is 2"},
      {R"({"gaussians": [{"position": 0, "height": 1, "width": 0.1, "xBias": 0.2}]})",
       "f: /gaussians/0/xBias: moves the top further"},
      {R"({"color": [[1, 1]]})", "f: /color/0: must have 3 numbers"},
      {R"({"color": [[1, 1, 1]], "color.position": [0, 1]})", "f: /color.position: has 2 numbers"},
      {R"({"color": [[1, 1, 1]], "valueRange": [1, 1]})", "f: /valueRange: is empty"},
      {"0,0\n", "f: line 1: has 2 numbers"},
      {"0,0,0\n0,0,0,0\n", "f: line 2: has 4 numbers"},
      {"0,0,nan\n", "f: line 1: \"nan\" is no number"},
      {"0,0,inf\n", "f: line 1: \"inf\" is no number"},
      {"0,0,256\n", "f: line 1: 256 must be from 0 to 1"},
      {"value,r,g,b\n1,0,0,0\n0,0,0,0\n", "f: color 1 lies at a smaller value"},
      {"hello\n", "f: line 1: the header is no"},
      {"r,g,b\n", "f: has no rows of numbers"},
      {"1\n1\n", "f: has 2 lines"},
      {"1\n1\n1\n1\n1\n1\n3 0 0\n2 0 1\n4 0 1 1 1\n", "f: line 7: does not begin with the count"},
      {"1\n1\n1\n1\n1\n1\n2 0 7\n2 0 1\n4 0 1 1 1\n", "f: line 7: 7 must be from 0 to 1"},
      {"<a/>", "f: is XML, but neither"},
      {"<ColorMap", "f: line 1: a tag does not end"},
      {"<ColorMap indexedLookup=\"true\"><Point x=\"0\" r=\"1\" g=\"0\" b=\"0\"/></ColorMap>",
       "f: line 1: has colors of categories"},
      {"x position,R,G,B\n0,0,0,0\n", "f: line 1: the header is no \"r,g,b\""},
      {"<ColorMap name=>", "f: line 1: <ColorMap> has an attribute without"},
      {"<ColorMap name=\"a\"><Point x=\"0\" r=\"1\" g=\"1\"/></ColorMap>",
       "f: line 1: <Point> has no b"},
      {"<Object name=\"GaussianControlPoint\"><Field name=\"x\">1</Field></Object>",
       "f: line 1: a control point has no height"}};
  for (const auto& [text, part] : cases) {
    const std::string message = error(text);
    EXPECT_TRUE(contains(message, part)) << text << "\n  " << message;
    EXPECT_EQ(message.rfind("f", 0), 0u) << message;
  }
  std::string many = "[{\"RGBPoints\": [";
  for (int i = 0; i <= 100'000; ++i) many += (i > 0 ? "," : "") + std::to_string(i) + ",0,0,0";
  EXPECT_TRUE(contains(error(many + "]}]"), "has 100001 colors, but at most 100000"));
}

TEST(Import, RefusesOptionsOutOfRange) {
  const auto error = [](const ImportOptions& options) {
    return test::error_of([&] { read("0,0,0\n1,1,1\n", options); });
  };
  ImportOptions options;
  options.deviation = 0;
  EXPECT_TRUE(contains(error(options), "deviation"));
  options = {};
  options.range = {{1, 1}};
  EXPECT_TRUE(contains(error(options), "range"));
  options = {};
  options.unit_distance = 0;
  EXPECT_TRUE(contains(error(options), "unit distance"));
  // The smallest deviation of a table of opposites.
  options = {};
  options.deviation = smallest_deviation;
  std::string rows;
  for (int i = 0; i < 2000; ++i) rows += i % 2 == 0 ? "0,0,0\n" : "1,1,1\n";
  EXPECT_TRUE(contains(test::error_of([&] { read(rows, options); }), "allow a larger deviation"));
}

}  // namespace
}  // namespace pellucid::test_import_formats
