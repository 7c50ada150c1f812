// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pellucid/io/channel_source.h"
#include "pellucid/io/field_source.h"
#include "pellucid/io/mesh_source.h"
#include "pellucid/io/transfer_function_description.h"
#include "pellucid/scene/scene.h"

namespace pellucid {

/// A scene as written: nothing is read or rendered yet. What is absent takes the default.
/// docs/reference/scene.md describes every key, scene.schema.json beside it is the JSON Schema.
struct SceneDescription {
  FieldSource field;
  std::vector<ChannelSource> channels;  ///< in place of the field, where there are any
  std::optional<MeshSource> mesh;       ///< in place of both
  std::optional<TransferFunctionDescription> transfer_function;
  std::optional<Camera> camera;
  ImageSize size;
  int samples = 1;
  Integration integration;
  /// The tolerance as a share of the picture's largest channel, in (0, 1], in place of
  /// integration.tolerance. The program `pellucid` looks for it; make_scene() does not, for the
  /// picture must be known first.
  std::optional<double> relative_tolerance;
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

/// The channels that the scene's function sees: its own, or its field, named "value", and behind it
/// "gradient_magnitude" and "second_derivative" of it where a Gaussian or a table names them. None
/// where a field has a function of one variable, or where there is a mesh.
std::vector<ChannelSource> scene_channels(const SceneDescription& description);
/// The names of the channels that a function of several would see.
std::vector<std::string> function_channels(const SceneDescription& description);
/// The names that a term of the scene's function may look at: of a field all three.
std::vector<std::string> known_channels(const SceneDescription& description);

/// Reads the data, and fills defaults for the transfer function of a field or of one array of a
/// mesh, and for the camera. `mesh_used` gets the scene's mesh, with the array that was taken where
/// it names none. Throws Error, also for several channels without a function of them.
Scene make_scene(const SceneDescription& description, const ParallelFor& parallel = {},
                 MeshSource* mesh_used = nullptr);

}  // namespace pellucid
