// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "pellucid/io/scene_json.h"
#include "pellucid/scene/builtin_fields.h"
#include "pellucid/scene/error.h"
#include "tests/support/one_layer.h"

namespace pellucid::test_scene_json {
namespace {

const std::filesystem::path scenes =
    std::filesystem::path(PELLUCID_SOURCE_DIR) / "tests" / "io" / "scenes";

std::string read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::filesystem::path> files(const char* folder) {
  std::vector<std::filesystem::path> list;
  for (const auto& entry : std::filesystem::directory_iterator(scenes / folder)) {
    if (entry.path().extension() == ".json") list.push_back(entry.path());
  }
  std::sort(list.begin(), list.end());
  EXPECT_FALSE(list.empty()) << folder;
  return list;
}

/// The message of the Error that the call throws; empty where it throws none.
template <class Call>
std::string error_of(Call&& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

std::string scene_error(std::string_view text) {
  return error_of([&] { parse_scene(text, "s.json"); });
}

bool same(double a, double b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}
bool same(const Vec3<double>& a, const Vec3<double>& b) {
  return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z);
}
bool same(const Rgb<double>& a, const Rgb<double>& b) {
  return same(a.r, b.r) && same(a.g, b.g) && same(a.b, b.b);
}
bool same(const std::vector<TransferFunction::Point>& a,
          const std::vector<TransferFunction::Point>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& p, const auto& q) {
    return same(p.value, q.value) && same(p.extinction, q.extinction) && same(p.color, q.color);
  });
}
bool same(const OpacityTable& a, const OpacityTable& b) {
  return same(a.unit_distance, b.unit_distance) &&
         same(a.extinction_deviation, b.extinction_deviation) &&
         same(a.color_deviation, b.color_deviation) &&
         std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(),
                    [](const auto& p, const auto& q) {
                      return same(p.value, q.value) && same(p.opacity, q.opacity) &&
                             same(p.color, q.color);
                    });
}
bool same(const std::vector<double>& a, const std::vector<double>& b);
bool same(const GaussianPrimitive& a, const GaussianPrimitive& b);
bool same(const ChannelTransferFunction& a, const ChannelTransferFunction& b);
bool same(const ChannelSource& a, const ChannelSource& b);
bool same(const LayerDescription& a, const LayerDescription& b);
bool same(const GradientOpacity::Point& a, const GradientOpacity::Point& b);
bool same(const std::shared_ptr<const GradientOpacity>& a,
          const std::shared_ptr<const GradientOpacity>& b);
bool same(const Isosurface& a, const Isosurface& b);
bool same(const Slice& a, const Slice& b);
bool same(const Light& a, const Light& b);
bool same(const Background& a, const Background& b);
template <class T>
bool same_lists(const std::vector<T>& a, const std::vector<T>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const T& p, const T& q) { return same(p, q); });
}
bool same(const std::vector<double>& a, const std::vector<double>& b) {
  return same_lists(a, b);
}
bool same(const GaussianShape& a, const GaussianShape& b) {
  if (a.index() != b.index()) return false;
  if (a.index() == 0) {
    const auto &p = std::get<0>(a), &q = std::get<0>(b);
    return same(p.widths, q.widths) && same_lists(p.axes, q.axes);
  }
  return same_lists(std::get<1>(a).covariance, std::get<1>(b).covariance);
}
bool same(const GaussianPrimitive& a, const GaussianPrimitive& b) {
  return a.channels == b.channels && same(a.center, b.center) && same_lists(a.matrix, b.matrix) &&
         a.shape.has_value() == b.shape.has_value() && (!a.shape || same(*a.shape, *b.shape)) &&
         same(a.extinction, b.extinction) && same(a.color, b.color);
}
bool same(const ChannelTransferFunction& a, const ChannelTransferFunction& b) {
  return a.channel == b.channel && same(a.function.points(), b.function.points());
}
bool same(const MultivariateDescription& a, const MultivariateDescription& b) {
  return a.channels == b.channels && same_lists(a.gaussians, b.gaussians) &&
         same_lists(a.tables, b.tables);
}
bool same(const TransferFunctionDescription& a, const TransferFunctionDescription& b) {
  if (a.index() != b.index()) return false;
  if (a.index() == 0) return same(std::get<0>(a), std::get<0>(b));
  if (a.index() == 1) return same(std::get<1>(a), std::get<1>(b));
  if (a.index() == 2) return same(std::get<2>(a), std::get<2>(b));
  const auto &p = std::get<PresetDescription>(a), &q = std::get<PresetDescription>(b);
  return p.name == q.name && p.range == q.range;
}
bool same(const Camera& a, const Camera& b) {
  return a.projection == b.projection && same(a.position, b.position) &&
         same(a.focal_point, b.focal_point) && same(a.up, b.up) &&
         same(a.vertical_angle, b.vertical_angle) && same(a.parallel_scale, b.parallel_scale);
}
template <class T>
bool same(const std::optional<T>& a, const std::optional<T>& b) {
  return a.has_value() == b.has_value() && (!a || same(*a, *b));
}
bool same(const FieldSource& a, const FieldSource& b) {
  const ReadOptions &p = a.options, &q = b.options;
  return a.file == b.file && a.builtin == b.builtin && a.points == b.points &&
         p.dimensions == q.dimensions && p.type == q.type &&
         p.big_endian.value_or(false) == q.big_endian.value_or(false) &&
         p.skip_bytes == q.skip_bytes && p.components == q.components &&
         p.component == q.component && p.component_name == q.component_name && p.array == q.array &&
         p.series == q.series && p.level == q.level && p.time == q.time &&
         same(p.spacing, q.spacing) && same(p.origin, q.origin) && p.centering == q.centering;
}
bool same(const ChannelSource& a, const ChannelSource& b) {
  if (a.name != b.name || a.unit != b.unit || a.source.index() != b.source.index()) return false;
  if (a.source.index() == 0) return same(std::get<0>(a.source), std::get<0>(b.source));
  const auto &p = std::get<1>(a.source), &q = std::get<1>(b.source);
  return p.kind == q.kind && p.channel == q.channel && same(p.sigma, q.sigma);
}
bool same(const Affine<double>& a, const Affine<double>& b) {
  return same(a.matrix.column[0], b.matrix.column[0]) &&
         same(a.matrix.column[1], b.matrix.column[1]) &&
         same(a.matrix.column[2], b.matrix.column[2]) && same(a.translation, b.translation);
}
bool same(const GradientOpacity::Point& a, const GradientOpacity::Point& b) {
  return same(a.gradient, b.gradient) && same(a.factor, b.factor);
}
bool same(const std::shared_ptr<const GradientOpacity>& a,
          const std::shared_ptr<const GradientOpacity>& b) {
  if (!a || !b) return a == b;
  return same_lists(a->points(), b->points()) && a->unit() == b->unit() &&
         a->channel() == b->channel();
}
template <class Surface>
bool same_colors(const Surface& a, const Surface& b) {
  if (!a.colors != !b.colors || !a.written_colors != !b.written_colors) return false;
  return (!a.colors || same(a.colors->points(), b.colors->points())) &&
         (!a.written_colors || same(*a.written_colors, *b.written_colors));
}
bool same(const Isosurface& a, const Isosurface& b) {
  return same(a.value, b.value) && same(a.opacity, b.opacity) && same(a.color, b.color) &&
         same_colors(a, b) && a.channel == b.channel && a.color_channel == b.color_channel;
}
bool same(const Slice& a, const Slice& b) {
  return same(a.point, b.point) && same(a.normal, b.normal) && same(a.opacity, b.opacity) &&
         same_colors(a, b) && a.channel == b.channel;
}
bool same(const Light& a, const Light& b) {
  return a.kind == b.kind && same(a.color, b.color);
}
bool same(const Background& a, const Background& b) {
  return same(a.top, b.top) && same(a.bottom, b.bottom);
}
bool same(const LayerDescription& a, const LayerDescription& b) {
  return a.name == b.name && a.visible == b.visible && same(a.field, b.field) &&
         same_lists(a.channels, b.channels) && same(a.transfer_function, b.transfer_function) &&
         same(a.transform, b.transform) && a.projection == b.projection && a.shading == b.shading &&
         same(a.gradient_opacity, b.gradient_opacity) && same_lists(a.isosurfaces, b.isosurfaces) &&
         same_lists(a.slices, b.slices);
}
bool same(const SceneDescription& a, const SceneDescription& b) {
  return same_lists(a.layers, b.layers) && same_lists(a.lights, b.lights) &&
         same(a.camera, b.camera) && a.size.width == b.size.width &&
         a.size.height == b.size.height && a.samples == b.samples &&
         a.integration.method == b.integration.method &&
         same(a.integration.tolerance, b.integration.tolerance) &&
         a.integration.relative_tolerance == b.integration.relative_tolerance &&
         a.integration.grade == b.integration.grade &&
         a.integration.precision == b.integration.precision &&
         same(a.integration.step, b.integration.step) && same(a.background, b.background) &&
         a.is_transparent == b.is_transparent && a.backdrop == b.backdrop;
}

TEST(SceneJson, EveryValidFileIsReadAndRoundTripsBitForBit) {
  for (const auto& path : files("valid")) {
    SCOPED_TRACE(path.filename());
    SceneDescription first;
    ASSERT_NO_THROW(first = parse_scene(read(path), path.filename().string(), scenes));
    const std::string text = scene_to_json(first);
    SceneDescription second;
    ASSERT_NO_THROW(second = parse_scene(text, "written")) << text;
    EXPECT_TRUE(same(first, second)) << text;
    EXPECT_EQ(scene_to_json(second), text);
  }
}

TEST(SceneJson, EveryInvalidFileGetsItsOneLine) {
  const auto expected = nlohmann::json::parse(read(scenes / "expected_errors.json"));
  std::set<std::string> seen;
  for (const auto& path : files("invalid")) {
    const std::string name = path.filename().string();
    seen.insert(name);
    ASSERT_TRUE(expected.contains(name)) << name << " is missing in expected_errors.json";
    const std::string error = error_of([&] { parse_scene(read(path), name); });
    EXPECT_NE(error.find(expected[name]["message"].get<std::string>()), std::string::npos)
        << name << ": " << (error.empty() ? "was accepted" : error);
    EXPECT_EQ(error.rfind(name + ": ", 0), 0U) << "does not begin with the file's name: " << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    EXPECT_LT(error.size(), 400U) << error;
  }
  EXPECT_EQ(seen.size(), expected.size()) << "expected_errors.json names a file that is not there";
}

TEST(SceneJson, ReadsWhatIsWritten) {
  const SceneDescription scene = parse_scene(read(scenes / "valid" / "perspective.json"), "s");
  EXPECT_EQ(scene.layers[0].field.builtin, "hydrogen");
  EXPECT_EQ(scene.layers[0].field.points, 64);
  ASSERT_TRUE(scene.layers[0].transfer_function);
  const auto& points =
      std::get<std::vector<TransferFunction::Point>>(*scene.layers[0].transfer_function);
  ASSERT_EQ(points.size(), 3U);
  EXPECT_EQ(points[1].value, 0.1);
  EXPECT_EQ(points[1].extinction, 3.7);
  EXPECT_EQ(points[2].extinction, 1000);
  EXPECT_EQ(points[2].color, (Rgb<double>{2, 1.7, 0}));
  ASSERT_TRUE(scene.camera);
  EXPECT_EQ(scene.camera->projection, Projection::perspective);
  EXPECT_EQ(scene.camera->position, (Vec3<double>{2, -3.5, 1e-3}));
  EXPECT_EQ(scene.camera->focal_point, (Vec3<double>{0, 0, 0.1}));
  EXPECT_EQ(scene.camera->up, (Vec3<double>{0, 0, 1}));
  EXPECT_EQ(scene.camera->vertical_angle, 40);
  EXPECT_EQ(scene.size.width, 321);
  EXPECT_EQ(scene.size.height, 123);
  ASSERT_TRUE(scene.background);
  EXPECT_EQ(*scene.background, (Rgb<double>{0, 0.01, 1}));
  EXPECT_EQ(scene.integration.method, Method::midpoint);
  EXPECT_EQ(scene.integration.precision, Precision::float64);
  EXPECT_EQ(scene.integration.step, 0.25);

  const SceneDescription raw = parse_scene(read(scenes / "valid" / "raw.json"), "s", "/scans");
  EXPECT_EQ(raw.layers[0].field.file, "/scans/data/male.RAW");
  EXPECT_EQ(raw.layers[0].field.options.dimensions, (std::array<int, 3>{128, 256, 256}));
  EXPECT_EQ(raw.layers[0].field.options.type, "u8");
  EXPECT_EQ(raw.layers[0].field.options.big_endian, true);
  EXPECT_EQ(raw.layers[0].field.options.skip_bytes, 12U);
  EXPECT_EQ(raw.layers[0].field.options.spacing, (Vec3<double>{1.5, 1, 1}));
  EXPECT_EQ(raw.layers[0].field.options.origin, (Vec3<double>{-96, 0, 1e-300}));
  EXPECT_EQ(raw.layers[0].field.options.centering, Centering::cell);
  EXPECT_FALSE(raw.layers[0].transfer_function);
  EXPECT_FALSE(raw.camera);
  EXPECT_FALSE(raw.background);
  EXPECT_EQ(raw.size.width, 512);
  EXPECT_EQ(raw.integration.method, Method::exact);
  EXPECT_EQ(raw.samples, 1);
  EXPECT_EQ(raw.integration.tolerance, 1.0 / 512);
  EXPECT_EQ(raw.integration.grade, Grade::estimated);
  EXPECT_EQ(raw.integration.precision, Precision::automatic);

  const SceneDescription opacity = parse_scene(read(scenes / "valid" / "opacity.json"), "s");
  ASSERT_TRUE(opacity.layers[0].transfer_function);
  const auto& table = std::get<OpacityTable>(*opacity.layers[0].transfer_function);
  EXPECT_EQ(table.unit_distance, 0.1);
  ASSERT_EQ(table.points.size(), 4U);
  EXPECT_EQ(table.points[1].value, 0.3);
  EXPECT_EQ(table.points[1].opacity, 0.1);
  EXPECT_EQ(table.points[3].opacity, 1);
  EXPECT_EQ(table.points[3].color, (Rgb<double>{0.5, 1, 1}));
  EXPECT_EQ(opacity.samples, 3);
  EXPECT_EQ(opacity.integration.tolerance, 1e-4);
  EXPECT_EQ(opacity.integration.grade, Grade::proved);
  EXPECT_EQ(opacity.integration.precision, Precision::float32);
}

TEST(SceneJson, ExamplesAndTheDocumentedSceneAreValid) {
  const std::filesystem::path source = PELLUCID_SOURCE_DIR;
  int examples = 0;
  for (const auto& entry : std::filesystem::directory_iterator(source / "examples")) {
    if (entry.path().extension() != ".json") continue;
    ++examples;
    EXPECT_EQ(error_of([&] { parse_scene(read(entry.path()), entry.path().string()); }), "");
  }
  EXPECT_GE(examples, 4);
  const std::string page = read(source / "docs" / "reference" / "scene.md");
  const std::size_t begin = page.find("```json\n") + 8, end = page.find("```", begin);
  ASSERT_NE(end, std::string::npos);
  EXPECT_EQ(
      error_of([&] { parse_scene(page.substr(begin, end - begin), "docs/reference/scene.md"); }),
      "");
  // Behind it stand a layer with a mesh, six scenes, a layer with channels, three transfer
  // functions, and an animated scene.
  std::vector<std::string> blocks;
  for (std::size_t at = end + 3; (at = page.find("```json\n", at)) != std::string::npos;) {
    const std::size_t from = at + 8;
    at = page.find("```", from);
    ASSERT_NE(at, std::string::npos);
    blocks.push_back(page.substr(from, at - from));
    at += 3;
  }
  ASSERT_EQ(blocks.size(), 12U);
  for (const std::string& layer : {blocks[0], blocks[7]}) {
    EXPECT_EQ(error_of([&] { parse_scene("{\"layers\": [" + layer + "]}", "scene.md"); }), "");
  }
  for (const std::string& scene :
       {blocks[1], blocks[2], blocks[3], blocks[4], blocks[5], blocks[6], blocks[11]}) {
    EXPECT_EQ(error_of([&] { parse_scene(scene, "scene.md"); }), "");
  }
  const auto function = [&](const std::string& text) {
    TransferFunctionDescription description;
    EXPECT_EQ(error_of([&] { description = parse_transfer_function(text, "scene.md"); }), "");
    return description;
  };
  EXPECT_TRUE(std::holds_alternative<OpacityTable>(function(blocks[8])));
  EXPECT_TRUE(std::holds_alternative<MultivariateDescription>(function(blocks[9])));
  EXPECT_TRUE(std::get<MultivariateDescription>(function(blocks[10])).factor);
}

TEST(SceneJson, AbsoluteFilesStayAndRelativeOnesStartAtTheFolder) {
  const auto file = [](const char* path, const char* folder) {
    return parse_scene("{\"volumes\": [{\"field\": {\"file\": \"" + std::string(path) + "\"}}]}",
                       "s", folder)
        .layers[0]
        .field.file;
  };
  EXPECT_EQ(file("a.nii", ""), "a.nii");
  EXPECT_EQ(file("a.nii", "there"), "there/a.nii");
  EXPECT_EQ(file("../a.nii", "there/x"), "there/x/../a.nii");
  EXPECT_EQ(file("/data/a.nii", "there"), "/data/a.nii");
}

TEST(SceneJson, SyntaxErrorsNameLineAndColumn) {
  EXPECT_EQ(
      scene_error("{\n\"volumes\" 3}").rfind("s.json: line 2, column 11: not valid JSON: ", 0), 0U)
      << scene_error("{\n\"volumes\" 3}");
  EXPECT_NE(scene_error("{\r\n\r\n  x").find("line 3, column 3"), std::string::npos);
  EXPECT_NE(scene_error(std::string_view("\0", 1)).find("line 1, column 1"), std::string::npos);
}

TEST(SceneJson, LongAndStrangeTextStaysOneShortLine) {
  const std::vector<std::string> texts{"{\"" + std::string(100000, 'k') + "\": 1}",
                                       "{\"a\": \"" + std::string(100000, 'v'),
                                       "{\"volumes\": \"" + std::string(100000, 's') + "\"}",
                                       "{\"\\u0007\\n\\u001b[31m\\u0000\": 1}",
                                       "{\"volumes\": \n\n\n",
                                       "{\"" + std::string(159, 'a') + "\xc3\xa4\xc3\xa4\": 1}"};
  for (const std::string& text : texts) {
    const std::string error = scene_error(text);
    EXPECT_FALSE(error.empty());
    EXPECT_LT(error.size(), 500U) << error;
    for (const char c : error) EXPECT_GE(static_cast<unsigned char>(c), 0x20) << error;
    // A cut in the middle of a character would not be UTF-8.
    EXPECT_NO_THROW(nlohmann::json(error).dump()) << error;
  }
}

TEST(SceneJson, WritingRefusesWhatJsonCannotHold) {
  SceneDescription scene;
  scene.layers[0].field.builtin = "ramp";
  scene.camera = Camera{};
  scene.camera->position.x = std::numeric_limits<double>::infinity();
  EXPECT_NE(error_of([&] { scene_to_json(scene); }).find("the camera's position is not a finite"),
            std::string::npos);
  scene.camera.reset();
  scene.layers[0].field.builtin.clear();
  scene.layers[0].field.file = "\xff.nii";
  EXPECT_NE(error_of([&] { scene_to_json(scene); }).find("not UTF-8"), std::string::npos);
}

TEST(TransferFunctionJson, StandsAloneBareOrUnderItsName) {
  const TransferFunction function({{0, 0, {0.1, 0.2, 0.3}}, {1.0 / 3, 4e-5, {1, 1, 1}}});
  const std::string bare = transfer_function_to_json(function);
  EXPECT_EQ(bare, transfer_function_to_json(TransferFunctionDescription(function.points())));
  const OpacityTable table{{{0, 0.3, {0.1, 0.2, 0.3}}, {1.0 / 3, 1, {1, 1, 1}}}, 0.7};
  const auto expect_read = [](const TransferFunctionDescription& description) {
    const std::string text = transfer_function_to_json(description);
    EXPECT_TRUE(same(parse_transfer_function(text, "t"), description)) << text;
    EXPECT_TRUE(
        same(parse_transfer_function("{\"transfer_function\": " + text + "}", "t"), description));
    EXPECT_TRUE(
        same(parse_transfer_function("{\"pellucid\": 1, \"transfer_function\": " + text + "}", "t"),
             description));
  };
  expect_read(function.points());
  expect_read(table);
  const auto error = [](const char* text) {
    return error_of([&] { parse_transfer_function(text, "t.json"); });
  };
  EXPECT_EQ(error("{\"points\": []}"),
            "t.json: /points: is empty; give at least one point {value, extinction, color}");
  EXPECT_NE(error("{\"transfer_function\": {\"points\": []}}").find("/transfer_function/points: "),
            std::string::npos);
  EXPECT_NE(error("{\"pellucid\": 3, \"transfer_function\": {}}").find("/pellucid: is version 3"),
            std::string::npos);
  EXPECT_NE(error("[]").find("must be an object"), std::string::npos);
}

TEST(TransferFunctionJson, TakesSrgbColorsAsSignals) {
  const auto points = std::get<std::vector<TransferFunction::Point>>(parse_transfer_function(
      R"({"color_space": "srgb", "points": [
           {"value": 0, "extinction": 1, "color": [0, 0.04, 1]},
           {"value": 1, "extinction": 1, "color": [0.5, 0.25, 0.75]}]})",
      "t"));
  // IEC 61966-2-1: 0.04/12.92 and ((x + 0.055)/1.055)^2.4, to 12 digits.
  EXPECT_NEAR(points[0].color.g, 0.00309597523220, 1e-14);
  EXPECT_EQ(points[0].color.b, 1);
  EXPECT_NEAR(points[1].color.r, 0.214041140482, 1e-12);
  EXPECT_NEAR(points[1].color.g, 0.0508760881716, 1e-12);
  EXPECT_NEAR(points[1].color.b, 0.522521553968, 1e-12);
  const auto linear = std::get<std::vector<TransferFunction::Point>>(parse_transfer_function(
      R"({"color_space": "linear", "points": [{"value": 0, "extinction": 1, "color": [0, 7, 1]}]})",
      "t"));
  EXPECT_EQ(linear[0].color.g, 7);
  const auto sum = std::get<MultivariateDescription>(parse_transfer_function(
      R"({"color_space": "srgb", "gaussians": [{"center": [0], "width": [1], "extinction": 1,
           "color": [0.5, 0, 0]}], "tables": [{"points": [
           {"value": 0, "extinction": 1, "color": [0.5, 0, 0]}]}]})",
      "t"));
  EXPECT_NEAR(sum.gaussians[0].color.r, 0.214041140482, 1e-12);
  EXPECT_NEAR(sum.tables[0].function.points()[0].color.r, 0.214041140482, 1e-12);
}

TEST(TransferFunctionJson, MakesOpacityTablesAsExactAsTheToleranceAsks) {
  for (const double tolerance : {1e-2, 1.0 / 512, 1e-4, 1e-6}) {
    for (const double brightest : {0.0, 0.5, 1.0, 30.0}) {
      const OpacityTable table{{{0, 0, {0, brightest, 0}}, {1, 0.9, {}}}, 0.1};
      const TransferFunction function = make_transfer_function(table, tolerance);
      EXPECT_LE(function.approximation_error(), tolerance / 8);
      EXPECT_GE(function.approximation_error(), tolerance / 32);
      const TransferFunction before_light =
          make_transfer_function(table, tolerance, Rgb<double>{0, 0, 10});
      EXPECT_LE(before_light.approximation_error(10), tolerance / 8);
    }
  }
  const std::vector<TransferFunction::Point> points{{0, 1, {}}, {1, 2, {1, 1, 1}}};
  const TransferFunction exact = make_transfer_function(points, 1e-2);
  EXPECT_TRUE(same(exact.points(), points));
  EXPECT_EQ(exact.approximation_error(), 0);
}

TEST(CameraJson, StandsAloneBareOrUnderItsName) {
  Camera camera;
  camera.position = {0.1, 0.2, 0.3};
  camera.up = {0, 0, 1};
  camera.vertical_angle = 33.3;
  const std::string bare = camera_to_json(camera);
  EXPECT_TRUE(same(parse_camera(bare, "c"), camera)) << bare;
  EXPECT_TRUE(same(parse_camera("{\"camera\": " + bare + "}", "c"), camera));

  camera.vertical_angle = 30;
  camera.projection = Projection::orthographic;
  camera.parallel_scale = 0.7;
  EXPECT_TRUE(same(parse_camera(camera_to_json(camera), "c"), camera));
  EXPECT_EQ(error_of([] { parse_camera("{}", "c.json"); }),
            "c.json: /position: is missing; give the camera's place [x, y, z]");
}

TEST(FieldSource, NamesBuiltinFieldsAndFiles) {
  EXPECT_EQ(parse_field_source("brain.nii.gz").file, "brain.nii.gz");
  EXPECT_EQ(parse_field_source("brain.nii.gz").builtin, "");
  EXPECT_EQ(parse_field_source("dir/builtin:x").file, "dir/builtin:x");
  EXPECT_EQ(parse_field_source("builtin:shells").builtin, "shells");
  EXPECT_EQ(parse_field_source("builtin:shells").points, 128);
  EXPECT_TRUE(parse_field_source("builtin:shells").file.empty());
  EXPECT_EQ(parse_field_source("builtin:ramp:2").points, 2);
  EXPECT_EQ(parse_field_source("builtin:ramp:2048").points, 2048);
  for (const char* wrong :
       {"builtin:ramp:1", "builtin:ramp:2049", "builtin:ramp:", "builtin:ramp:x",
        "builtin:ramp:64 ", "builtin:ramp:6.4", "builtin:ramp:99999999999", "builtin:ramp:64:64"}) {
    const std::string error = error_of([&] { parse_field_source(wrong); });
    EXPECT_NE(error.find("but must be an integer from 2 to 2048"), std::string::npos)
        << wrong << ": " << error;
  }
  EXPECT_NE(error_of([] { parse_field_source("builtin:shels"); }).find("did you mean \"shells\"?"),
            std::string::npos);
  EXPECT_NE(error_of([] { parse_field_source("builtin:"); }).find("no built-in field"),
            std::string::npos);
  EXPECT_NE(error_of([] { parse_field_source(""); }).find("is empty"), std::string::npos);
}

TEST(MakeScene, FillsDefaults) {
  SceneDescription description;
  description.layers[0].field = parse_field_source("builtin:sphere:17");
  description.size = {64, 48};
  const Scene scene = make_scene(description);
  const VolumeContent& content = test::volume_of(scene);
  ASSERT_TRUE(content.volume);
  EXPECT_EQ(content.volume->description().dimensions, (std::array<int, 3>{17, 17, 17}));
  ASSERT_TRUE(content.transfer_function);
  EXPECT_GE(content.transfer_function->points().size(), 2U);
  EXPECT_EQ(scene.size.width, 64);
  EXPECT_NO_THROW(make_camera_frame(scene.camera, scene.size));
  EXPECT_FALSE(scene.background);
}

TEST(MakeScene, KeepsWhatIsGiven) {
  SceneDescription description;
  description.layers[0].field = parse_field_source("builtin:ramp:3");
  const std::vector<TransferFunction::Point> points{{0.5, 2, {1, 0, 0}}};
  description.layers[0].transfer_function = points;
  description.samples = 4;
  description.camera = Camera{};
  description.camera->vertical_angle = 12;
  description.integration.method = Method::simpson;
  description.background = Rgb<double>{1, 1, 1};
  const Scene scene = make_scene(description);
  EXPECT_TRUE(same(test::volume_of(scene).transfer_function->points(), points));
  EXPECT_EQ(scene.samples, 4);
  EXPECT_TRUE(same(scene.camera, *description.camera));
  EXPECT_EQ(scene.integration.method, Method::simpson);
  EXPECT_TRUE(same(scene.background, description.background));
}

TEST(MakeScene, SaysWhichFileIsMissing) {
  SceneDescription description;
  description.layers[0].field = parse_field_source("/nowhere/at-all.nii.gz");
  EXPECT_NE(error_of([&] { make_scene(description); }).find("/nowhere/at-all.nii.gz"),
            std::string::npos);
}

TEST(MakeScene, TakesTheToleranceForOpacityTables) {
  SceneDescription description;
  description.layers[0].field = parse_field_source("builtin:ramp:3");
  description.layers[0].transfer_function =
      OpacityTable{{{0, 0, {1, 1, 1}}, {1, 0.99, {1, 1, 1}}}, 0.5};
  description.background = Rgb<double>{4, 0, 0};
  description.integration.tolerance = 1e-5;
  const Scene scene = make_scene(description);
  EXPECT_LE(test::volume_of(scene).transfer_function->approximation_error(4), 1e-5 / 8);
  EXPECT_GE(test::volume_of(scene).transfer_function->approximation_error(4), 1e-5 / 16);
  EXPECT_EQ(scene.integration.tolerance, 1e-5);
}

}  // namespace
}  // namespace pellucid::test_scene_json
