// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "pellucid/io/read_volume.h"
#include "pellucid/scene/opacity_table.h"
#include "pellucid/scene/scene.h"

namespace pellucid {

/// A field as a scene names it: a file, or a built-in field with its size.
struct FieldSource {
  std::filesystem::path file;  ///< empty: built-in
  ReadOptions options;
  std::string builtin;  ///< one of builtin_field_names()
  int points = 128;     ///< per axis; built-in
};

/// "builtin:NAME" and "builtin:NAME:POINTS" are built-in fields; anything else is a file's path.
/// Throws Error for an unknown name or a wrong number of points.
FieldSource parse_field_source(std::string_view text);

/// An opacity table as other programs have it: opacities of a layer as thick as unit_distance.
struct OpacityTable {
  std::vector<OpacityPoint> points;
  double unit_distance = 1;  ///< in world units
};

/// A transfer function as written: points with extinctions, or an opacity table.
using TransferFunctionDescription =
    std::variant<std::vector<TransferFunction::Point>, OpacityTable>;

/// A scene as written: nothing is read or rendered yet. What is absent takes the default.
/// docs/scene.md tells of every key, docs/scene.schema.json is the JSON Schema (draft 2020-12).
struct SceneDescription {
  FieldSource field;
  std::optional<TransferFunctionDescription> transfer_function;
  std::optional<Camera> camera;
  ImageSize size;
  int samples = 1;
  Integration integration;
  std::optional<Rgb<double>> background;
};

/// Parses and validates; reads no other file. Relative files are taken from `folder`. `name` (the
/// file's) opens every message. Throws Error: one line with line and column where the text is not
/// JSON, else with the JSON pointer of the key, e.g.
/// "scene.json: /camera/vertical_angle: is 200, but must be above 0 and below 180".
SceneDescription parse_scene(std::string_view json, const std::string& name,
                             const std::filesystem::path& folder = {});
/// The document that parse_scene reads back to the same description, bit for bit. Throws Error
/// where a path is not UTF-8 or a number is not finite.
std::string scene_to_json(const SceneDescription& description);

/// A transfer function alone: the object that stands under "transfer_function" in a scene, or a
/// document {"transfer_function": that object}. Throws Error like parse_scene.
TransferFunctionDescription parse_transfer_function(std::string_view json, const std::string& name);
/// The bare object, without a line end: what parse_transfer_function reads back, an opacity table
/// as it was given. Throws Error where a number is not finite.
std::string transfer_function_to_json(const TransferFunctionDescription& description);
/// The same of the points alone, those that stand for an opacity table included. Throws nothing: a
/// TransferFunction's numbers are finite.
std::string transfer_function_to_json(const TransferFunction& transfer_function);

/// A camera alone: the object that stands under "camera" in a scene, or {"camera": that object}.
Camera parse_camera(std::string_view json, const std::string& name);
/// The bare object. Throws Error where a number is not finite.
std::string camera_to_json(const Camera& camera);

/// What an opacity table may add to the error of any channel: an eighth of the tolerance.
constexpr double opacity_table_share(double tolerance) noexcept {
  return tolerance / 8;
}
/// The transfer function itself. An opacity table is approximated to within
/// opacity_table_share(tolerance), seen over that background; points are taken as they are. Throws
/// Error.
TransferFunction make_transfer_function(const TransferFunctionDescription& description,
                                        double tolerance,
                                        const std::optional<Rgb<double>>& background = {});

/// Reads the file or makes the built-in field. Throws Error.
Volume load_field(const FieldSource& source);
/// Reads the field, and fills defaults for the transfer function and the camera. Throws Error.
Scene make_scene(const SceneDescription& description);

}  // namespace pellucid
