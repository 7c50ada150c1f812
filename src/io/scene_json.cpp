// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/scene_json.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <memory>
#include <utility>

#include "pellucid/scene/builtin_fields.h"
#include "pellucid/scene/error.h"
#include "scene_json_document.h"

namespace pellucid {
namespace {

using scene_json::Node;

constexpr int newest_version = 1;
constexpr int largest_grid = 1 << 20;
constexpr long long largest_skip = 1LL << 50;

void check_version(const Node& document) {
  if (const auto version = document.find("pellucid")) {
    const long long number = version->integer(1, 1'000'000);
    if (number != newest_version) {
      version->fail("is version " + std::to_string(number) +
                    ", but this program reads version 1; take a newer pellucid");
    }
  }
}

std::array<Node, 3> three(const Node& node) {
  if (node.array_size() != 3) {
    node.fail("must have 3 numbers, but has " + std::to_string(node.array_size()));
  }
  return {node.element(0), node.element(1), node.element(2)};
}

Vec3<double> vector(const Node& node) {
  const auto [x, y, z] = three(node);
  return {x.number(), y.number(), z.number()};
}

Rgb<double> linear_rgb(const Node& node) {
  const auto [r, g, b] = three(node);
  const double largest = scene_json::largest_number;
  return {r.number(0, largest), g.number(0, largest), b.number(0, largest)};
}

bool ends_with_extension(std::string file, std::initializer_list<std::string_view> extensions) {
  std::transform(file.begin(), file.end(), file.begin(), [](char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  });
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](std::string_view e) { return std::string_view(file).ends_with(e); });
}

FieldSource builtin_source(const Node& field) {
  field.expect_object({"builtin", "points"});
  FieldSource source;
  source.builtin = builtin_field_names()[field.at("builtin", "").one_of(builtin_field_names())];
  if (const auto points = field.find("points")) {
    source.points = static_cast<int>(points->integer(2, 2048));
  }
  return source;
}

FieldSource file_source(const Node& field, const std::filesystem::path& folder) {
  field.expect_object(
      {"file", "dimensions", "type", "byte_order", "skip_bytes", "spacing", "origin", "centering"});
  FieldSource source;
  const Node file = field.at("file", "");
  const std::string& path = file.string();
  if (path.empty()) file.fail("is empty; give the path of a volume file");
  if (path.find('\0') != std::string::npos) file.fail("has a NUL character");
  source.file = folder / std::filesystem::path(std::u8string(path.begin(), path.end()));

  // Files with a header say these themselves; two sources of one truth would have to be compared.
  if (ends_with_extension(path, {".nii", ".nii.gz", ".hdr", ".hdr.gz", ".img", ".img.gz", ".nrrd",
                                 ".nhdr", ".mha", ".mhd", ".npy"})) {
    for (const char* key : {"dimensions", "type", "byte_order", "skip_bytes"}) {
      if (field.has(key)) {
        field.fail_at(key, "makes no sense for " + scene_json::printable(path) +
                               ", which has a header; remove it (it is for headerless .raw)");
      }
    }
  }
  if (ends_with_extension(path, {".raw"})) {
    field.at("dimensions", "a headerless file needs [x, y, z]");
    field.at("type", "a headerless file needs one, e.g. \"u8\" or \"f32\"");
  }

  if (const auto dimensions = field.find("dimensions")) {
    const auto [x, y, z] = three(*dimensions);
    source.options.dimensions = {static_cast<int>(x.integer(1, largest_grid)),
                                 static_cast<int>(y.integer(1, largest_grid)),
                                 static_cast<int>(z.integer(1, largest_grid))};
  }
  if (const auto type = field.find("type")) {
    type->one_of({"u8", "i8", "u16", "i16", "u32", "i32", "f32", "f64"});
    source.options.type = type->string();
  }
  if (const auto order = field.find("byte_order")) {
    source.options.big_endian = order->one_of({"little", "big"}) == 1;
  }
  if (const auto skip = field.find("skip_bytes")) {
    source.options.skip_bytes = static_cast<std::size_t>(skip->integer(0, largest_skip));
  }
  if (const auto spacing = field.find("spacing")) {
    const auto [x, y, z] = three(*spacing);
    source.options.spacing = {x.positive_number(), y.positive_number(), z.positive_number()};
  }
  if (const auto origin = field.find("origin")) source.options.origin = vector(*origin);
  if (const auto centering = field.find("centering")) {
    source.options.centering =
        centering->one_of({"point", "cell"}) == 0 ? Centering::point : Centering::cell;
  }
  return source;
}

FieldSource field_source(const Node& field, const std::filesystem::path& folder) {
  field.expect_object({"file", "dimensions", "type", "byte_order", "skip_bytes", "spacing",
                       "origin", "centering", "builtin", "points"});
  if (field.has("file") == field.has("builtin")) {
    field.fail(field.has("file") ? "has both \"file\" and \"builtin\"; keep one of them"
                                 : "needs \"file\" or \"builtin\"");
  }
  return field.has("file") ? file_source(field, folder) : builtin_source(field);
}

/// The members of a point that both kinds have, and the order of the values.
template <class Point>
void read_place(const Node& node, std::vector<Point>& points) {
  const Node value = node.at("value", "give the data value of this point");
  const Rgb<double> color = linear_rgb(node.at("color", "give linear [r, g, b]"));
  const std::size_t i = points.size();
  points.push_back({value.number(), 0, color});
  if (i >= 1 && points[i].value < points[i - 1].value) {
    value.fail("is below the value of the point before it; points must ascend");
  }
  if (i >= 2 && points[i].value == points[i - 2].value) {
    value.fail("is the third equal value; two make a jump, remove the middle one");
  }
}

TransferFunctionDescription extinction_points(const Node& list) {
  std::vector<TransferFunction::Point> points;
  for (std::size_t i = 0; i < list.array_size(); ++i) {
    const Node point = list.element(i);
    if (point.has("opacity")) {
      point.fail_at("opacity",
                    "needs a \"unit_distance\" beside \"points\"; or give the extinction");
    }
    point.expect_object({"value", "extinction", "color"});
    const double extinction = point.at("extinction", "give the extinction per world length here")
                                  .number(0, scene_json::largest_number);
    read_place(point, points);
    points.back().extinction = extinction;
  }
  // What floats hold may be narrower than what is checked here (values that coincide in float).
  try {
    TransferFunction checked(points);
  } catch (const Error& error) {
    list.fail(error.what());
  }
  return points;
}

TransferFunctionDescription opacity_table(const Node& list, double unit_distance) {
  OpacityTable table;
  table.unit_distance = unit_distance;
  for (std::size_t i = 0; i < list.array_size(); ++i) {
    const Node point = list.element(i);
    if (point.has("extinction")) {
      point.fail_at("extinction",
                    "stands in a function with a \"unit_distance\"; give the opacity instead, in "
                    "all points, or remove the unit_distance");
    }
    point.expect_object({"value", "opacity", "color"});
    const double opacity =
        point.at("opacity", "give the opacity of a layer as thick as unit_distance").number(0, 1);
    read_place(point, table.points);
    table.points.back().opacity = opacity;
  }
  return table;
}

TransferFunctionDescription transfer_function(const Node& function) {
  function.expect_object({"type", "unit_distance", "points"});
  if (const auto type = function.find("type")) type->one_of({"piecewise_linear"});
  const auto unit_distance = function.find("unit_distance");
  const Node list = function.at("points", "give an array of {value, extinction, color}");
  if (list.array_size() == 0) {
    list.fail(std::string("is empty; give at least one point {value, ") +
              (unit_distance ? "opacity" : "extinction") + ", color}");
  }
  if (!unit_distance) return extinction_points(list);
  return opacity_table(list, unit_distance->number(smallest_unit_distance, largest_unit_distance));
}

Camera camera_from(const Node& node, ImageSize size) {
  node.expect_object(
      {"projection", "position", "focal_point", "up", "vertical_angle", "parallel_scale"});
  Camera camera;
  if (const auto projection = node.find("projection")) {
    camera.projection = projection->one_of({"perspective", "orthographic"}) == 0
                            ? Projection::perspective
                            : Projection::orthographic;
  }
  camera.position = vector(node.at("position", "give the camera's place [x, y, z]"));
  camera.focal_point = vector(node.at("focal_point", "give a point [x, y, z] to look at"));
  if (const auto up = node.find("up")) camera.up = vector(*up);
  const bool perspective = camera.projection == Projection::perspective;
  if (const char* other = perspective ? "parallel_scale" : "vertical_angle"; node.has(other)) {
    node.fail_at(other, perspective
                            ? "makes no sense in a perspective camera; give \"vertical_angle\""
                            : "makes no sense in an orthographic camera; give \"parallel_scale\"");
  }
  if (const auto angle = node.find("vertical_angle")) {
    camera.vertical_angle = angle->number_between(0, 180);
  }
  if (!perspective) {
    camera.parallel_scale =
        node.at("parallel_scale", "give half of the image's height in world units")
            .positive_number();
  }
  try {
    make_camera_frame(camera, size);
  } catch (const Error& error) {
    node.fail(error.what());
  }
  return camera;
}

void read_integration(const Node& node, Integration& integration) {
  node.expect_object({"method", "tolerance", "grade", "precision", "step"});
  if (const auto method = node.find("method")) {
    method->one_of({"exact", "rectangle", "taylor", "midpoint", "trapezoid", "simpson", "linear",
                    "preintegrated"});
    integration.method = *method_from_name(method->string());
  }
  if (const auto tolerance = node.find("tolerance")) {
    integration.tolerance = tolerance->number(smallest_tolerance, largest_tolerance);
  }
  if (const auto grade = node.find("grade")) {
    integration.grade =
        std::array{Grade::estimated, Grade::proved}[grade->one_of({"estimated", "proved"})];
  }
  if (const auto precision = node.find("precision")) {
    integration.precision =
        std::array{Precision::automatic, Precision::float32,
                   Precision::float64}[precision->one_of({"automatic", "float", "double"})];
  }
  if (const auto step = node.find("step")) integration.step = step->positive_number(largest_step);
}

/// The object that stands alone, or under its name in a document of its own.
Node unwrap(const Node& document, std::string_view key) {
  if (!document.is_object() || !document.has(key)) return document;
  document.expect_object({"pellucid", key});
  check_version(document);
  return document.at(key, "");
}

}  // namespace

SceneDescription parse_scene(std::string_view json, const std::string& name,
                             const std::filesystem::path& folder) {
  const nlohmann::json parsed = scene_json::parse_document(json, name);
  const Node document(parsed, name);
  document.expect_object({"pellucid", "volumes", "camera", "image", "integration"});
  check_version(document);

  const Node volumes = document.at("volumes", "give one volume: [{\"field\": {\"file\": ...}}]");
  if (volumes.array_size() != 1) {
    volumes.fail("has " + std::to_string(volumes.array_size()) +
                 " volumes, but this version renders exactly one");
  }
  const Node volume = volumes.element(0);
  volume.expect_object({"field", "transfer_function"});

  SceneDescription scene;
  scene.field =
      field_source(volume.at("field", "give {\"file\": ...} or {\"builtin\": ...}"), folder);
  if (const auto function = volume.find("transfer_function")) {
    scene.transfer_function = transfer_function(*function);
  }
  if (const auto image = document.find("image")) {
    image->expect_object({"width", "height", "samples", "background"});
    constexpr int largest_size = 65536;
    if (const auto width = image->find("width")) {
      scene.size.width = static_cast<int>(width->integer(1, largest_size));
    }
    if (const auto height = image->find("height")) {
      scene.size.height = static_cast<int>(height->integer(1, largest_size));
    }
    if (const auto samples = image->find("samples")) {
      scene.samples = static_cast<int>(samples->integer(1, largest_samples));
    }
    if (const auto background = image->find("background")) {
      scene.background = linear_rgb(*background);
    }
  }
  if (const auto camera = document.find("camera")) {
    scene.camera = camera_from(*camera, scene.size);
  }
  if (const auto integration = document.find("integration")) {
    read_integration(*integration, scene.integration);
  }
  return scene;
}

TransferFunctionDescription parse_transfer_function(std::string_view json,
                                                    const std::string& name) {
  const nlohmann::json parsed = scene_json::parse_document(json, name);
  return transfer_function(unwrap(Node(parsed, name), "transfer_function"));
}

Camera parse_camera(std::string_view json, const std::string& name) {
  const nlohmann::json parsed = scene_json::parse_document(json, name);
  return camera_from(unwrap(Node(parsed, name), "camera"), {});
}

}  // namespace pellucid
