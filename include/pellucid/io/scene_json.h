// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pellucid/io/animation.h"
#include "pellucid/io/channel_source.h"
#include "pellucid/io/field_source.h"
#include "pellucid/io/mesh_source.h"
#include "pellucid/io/transfer_function_description.h"
#include "pellucid/scene/function_change.h"
#include "pellucid/scene/look.h"
#include "pellucid/scene/scene.h"

namespace pellucid {

/// A segmentation as named in a scene, with the look of its labels.
struct LabelSource {
  FieldSource field;
  /// Looks by label; they replace those of the table. Both empty: default_label_table().
  std::vector<LabelStyle> styles;
  std::filesystem::path table;  ///< of ITK-SNAP or 3D Slicer (read_label_table()); may be empty
  /// Extinction of labels that the table shows as opaque; none: that of default_label_table().
  std::optional<double> extinction;
};

/// Labels that choose the transfer function of a layer's field (LabelMask).
struct MaskSource {
  struct Choice {
    std::int32_t label = 0;
    TransferFunctionDescription transfer_function;
  };
  FieldSource field;
  std::vector<Choice> choices;
};

/// That a volume or a mesh without function, projection, mask and surfaces is shown by
/// choose_look().
struct WantedLook {
  std::string name{};          ///< of looks(); empty: the one for the data
  bool has_function = false;   ///< whether one without a function gives way to "haze"
  bool keeps_shading = false;  ///< whether the layer's own shading counts, also if it has none
  std::function<void(const Look&)> chosen{};  ///< is told the look; may be empty
};

/// A layer as written in a file: how it looks and where it lies, and the sources of its data and of
/// its function. make_scene() makes the content, which is empty here, and finds the indices of
/// channels that have names. Absent keys have their defaults.
struct LayerDescription : Layer {
  FieldSource field;
  std::vector<ChannelSource> channels;  ///< replaces `field` unless empty
  std::optional<MeshSource> mesh;       ///< replaces `field` and `channels`
  std::optional<LabelSource> labels;    ///< replaces all of these
  /// None: nothing but the surfaces is visible if there are any, else made from the data.
  std::optional<TransferFunctionDescription> transfer_function;
  /// Change of a function of one variable, the default included. complete_description() writes the
  /// points that it gives; scene files have those.
  FunctionChange function_change;
  std::optional<MaskSource> mask;
  /// Scene files do not have it: complete_description() writes down what it came to.
  std::optional<WantedLook> look;

  bool shows_surfaces() const noexcept { return !isosurfaces.empty() || !slices.empty(); }
};

/// A scene as written in a file; no data are read or rendered yet. Absent keys have their defaults.
/// docs/reference/scene.md describes every key; scene.schema.json beside it is the JSON Schema.
struct SceneDescription : SceneSettings {
  std::vector<LayerDescription> layers{LayerDescription{}};
  std::optional<Camera> camera;  ///< none: default_camera() of visible_corners()
  /// True if a .png keeps its transparency; if not, one without a background gets
  /// calm_background().
  bool is_transparent = false;
  std::filesystem::path backdrop;  ///< an .exr with depth (Scene::backdrop); may be empty
  /// Time of all data that have steps and no time of their own: the nearest step is read.
  std::optional<double> time;
  std::optional<Animation> animation;
};

/// Returns what a .png of the scene has behind its data; none: it keeps its transparency.
std::optional<Background> shown_background(const SceneDescription& scene);

/// Parses and validates a scene; reads no other file. Relative paths are resolved against `folder`.
/// `name` (the file's) opens every message. Throws Error: one line with line and column if the text
/// is not JSON, else with the JSON pointer of the key, for example "scene.json:
/// /camera/vertical_angle: is 200, but must be above 0 and below 180".
SceneDescription parse_scene(std::string_view json, const std::string& name,
                             const std::filesystem::path& folder = {});
/// Returns a document that parse_scene() reads back to the same description, bit for bit. Throws
/// Error if a path is not UTF-8 or a number is not finite.
std::string scene_to_json(const SceneDescription& description);

/// A path that no file can have. In a description it stands for an array in memory.
inline constexpr const char* array_in_memory = "/dev/null/array";
/// Returns whether the data come from a file or are built in, so that they can be read again.
bool has_source(const FieldSource& field);
/// Throws Error, which names the layer, if data of the description are arrays in memory, which a
/// scene file cannot hold.
void check_has_sources(const SceneDescription& description);

/// Returns the keys "shading", "gradient_opacity", "isosurfaces" and "slices" of a layer as an
/// object, in JSON: those that the layer has. Throws Error if a number is not finite.
std::string layer_look_to_json(const LayerDescription& layer);
/// Returns the array under "lights" of a scene. Throws Error if a number is not finite.
std::string lights_to_json(const std::vector<Light>& lights);

/// Parses a transfer function: the object under "transfer_function" of a scene, or a document
/// {"transfer_function": object, "shading": object, "gradient_opacity": object}, of which the last
/// two may be absent. Throws Error like parse_scene().
LookDescription parse_look(std::string_view json, const std::string& name);
/// Returns such a document, or the bare object if there is nothing beside it; without a line end.
/// Throws Error if a number is not finite.
std::string look_to_json(const LookDescription& look);
/// Parses the same and returns the transfer function alone.
TransferFunctionDescription parse_transfer_function(std::string_view json, const std::string& name);
/// Returns the bare object without a line end, which parse_transfer_function() reads back; an
/// opacity table stays one. Throws Error if a number is not finite.
std::string transfer_function_to_json(const TransferFunctionDescription& description);
/// Returns the same for the points alone, including those made from an opacity table. Never throws
/// Error: a TransferFunction's numbers are finite.
std::string transfer_function_to_json(const TransferFunction& transfer_function);

/// Parses a camera: the object under "camera" of a scene, or a document {"camera": object}. Throws
/// Error like parse_scene().
Camera parse_camera(std::string_view json, const std::string& name);
/// Returns the bare object. Throws Error if a number is not finite.
std::string camera_to_json(const Camera& camera);

/// Parses the object under "animation" of a scene. Throws Error like parse_scene().
Animation parse_animation(std::string_view json, const std::string& name);
/// Returns the object. Throws Error if a number is not finite.
std::string animation_to_json(const Animation& animation);

/// Returns the channels that the layer's function uses: the layer's own channels, or its field as
/// "value", followed by the field's "gradient_magnitude" and "second_derivative" if a Gaussian or a
/// table names them. Empty for a field with a function of one variable, for a mesh and for labels.
std::vector<ChannelSource> layer_channels(const LayerDescription& layer);
/// Returns the names of the channels that a multivariate function of this layer would use.
std::vector<std::string> function_channels(const LayerDescription& layer);
/// Returns the names that a term of the layer's function may refer to; for a field all three.
std::vector<std::string> known_channels(const LayerDescription& layer);

/// Names every channel that the layer's shading, gradient opacity, isosurfaces and slices give by
/// an index, but the first one, which needs no name. Throws Error for an index that is not there.
void name_channels(LayerDescription& layer);

/// Reads the data, and adds the defaults for the camera (default_camera() of visible_corners()),
/// for the transfer function of a field or of one array of a mesh (of a projected layer:
/// projection_transfer_function()), and for the look of labels. A layer with isosurfaces or slices
/// and without a function is transparent between them.
/// `meshes_used` receives the mesh of each layer, with the default array if the layer selects none;
/// without a file for other layers. Throws Error, also if there are several channels and neither a
/// function of them nor a surface, or if a name of a channel is not there.
///
/// Opacity tables are fitted as by fit_opacity_tables().
Scene make_scene(const SceneDescription& description, const ParallelFor& parallel = {},
                 std::vector<MeshSource>* meshes_used = nullptr);

/// Calls visit(field) with every field that the layer's data, labels and mask are read from.
void visit_sources(LayerDescription& layer, const std::function<void(FieldSource&)>& visit);
/// Calls visit(path) with every path of the description, empty ones too, to be looked at or
/// changed.
void visit_paths(SceneDescription& description,
                 const std::function<void(std::filesystem::path&)>& visit);

/// Returns the channels that a layer has, its field as "value"; none of meshes and labels.
std::vector<Channel> loaded_channels(const Layer& layer);

/// Returns layer number `layer` of the description with the data of `loaded`, which was made from
/// the same data with another look. Reads nothing, unless the look needs channels that `loaded`
/// lacks and that cannot be computed from its own. Opacity tables are fitted by
/// fit_opacity_tables() afterwards. Throws Error as make_scene() does.
Layer remake_layer(const SceneDescription& description, std::size_t layer, const Layer& loaded,
                   const ParallelFor& parallel = {});

/// Writes what defaults and presets made of a layer into its description, so that the description
/// leaves nothing open.
void complete_description(const Layer& layer, LayerDescription& description);

/// Makes the points that stand for opacity tables again, for the tolerance of the scene and for
/// what is seen behind each: background, backdrop and, if there are several, the other layers.
void fit_opacity_tables(const SceneDescription& description, Scene& scene);

}  // namespace pellucid
