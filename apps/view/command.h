// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "layer_values.h"
#include "pellucid/scene/scene.h"

namespace pellucid::view {

using Json = nlohmann::ordered_json;

// What a page asks for. Distances on the picture are fractions of its height, x to the right and y
// downwards. Positions on the picture are fractions of its width and height. `layer` counts from 0.

/// Renders pictures of this size, which is that of the page in device pixels.
struct Resize {
  int width, height;
};
/// Turns the camera around its focal point.
struct Turn {
  double x, y;
};
/// Moves the camera along with the picture.
struct Pan {
  double x, y;
};
/// Enlarges the picture by a factor.
struct Zoom {
  double factor;
};
/// Turns the picture counterclockwise.
struct Roll {
  double degrees;
};
/// Moves the focal point to what is seen at a position.
struct Center {
  double x, y;
};
/// Takes the camera of the start.
struct ResetCamera {};
/// Looks from a side, one of view_names().
struct LookFrom {
  std::string side;
};
struct SetProjection {
  Projection projection;
};
struct SetTolerance {
  double tolerance;
};
/// Replaces a part of a layer, or of the scene if there is no layer: an editable key (scene_edit.h)
/// of a scene file with its value; null removes it. Edits of one gesture are undone together.
struct Edit {
  std::optional<std::size_t> layer;
  std::string key;
  Json value;
  int gesture;
};
struct Undo {};
struct Redo {};
/// Replaces the transfer function of a layer by one that is made from the data.
struct Suggest {
  enum class Kind { curve, gaussians };
  std::size_t layer;
  Kind kind;
};
/// Ends the fit of Gaussians that goes on, if there is one.
struct CancelFit {};
/// Replaces the transfer function of a layer by that of a file.
struct ImportFunction {
  std::size_t layer;
  std::string name, text;
};
/// Asks for the transfer function of a layer in a format: "pellucid" or one of ExportFormat.
struct ExportFunction {
  std::size_t layer;
  std::string format;
};
/// Asks for counts of the values of one or two channels, from 0.1 to 99.9 % of the values or over
/// ranges.
struct AskHistogram {
  /// Lower and upper end; none: by the values. `all`: from the least to the largest value.
  struct Range {
    double lower, upper;
  };
  std::size_t layer;
  std::vector<std::string> channels;
  bool all = false;
  std::vector<Range> ranges{};  ///< one for each channel, or none
};
/// Asks for a small picture of a layer with a preset's function.
struct AskThumbnail {
  std::size_t layer;
  Json function;  ///< as the value of an edit
};
/// Asks what is seen at a position.
struct Probe {
  double x, y;
  bool picks = false;  ///< True for a click; the answer says so too
};
/// Asks for values and labels in a slice.
struct AskSlice {
  SlicePlane plane;
  std::optional<std::size_t> layer;  ///< whose values are asked for; none: labels alone
  int channel = 0;
};
/// Asks for the data at a position of the world.
struct Locate {
  Vec3<double> position;
};
/// Moves the handle of a clip of the scene (overlay.h).
struct DragHandle {
  std::size_t clip;
  std::string handle;
  double x, y;
  int gesture;
};
struct ShowErrorMap {
  bool shown;
};
/// Shows another component of a layer's file: a step of time, a channel of color.
struct ChooseComponent {
  std::size_t layer;
  int component;
};
/// Shows another array of a layer's file, with the function that is made from it.
struct ChooseArray {
  std::size_t layer;
  std::string array;
};
/// Shows the step of a mesh that is nearest to a time.
struct ChooseTime {
  std::size_t layer;
  double time;
};
/// Shows all data that have steps at a time.
struct SetTime {
  double time;
};
/// Shows a frame of the film, counted from 0.
struct ShowFilmFrame {
  int frame;
};
/// Changes the film. A keyframe is counted from 0, in the order of time.
struct EditFilm {
  /// set_keyframe: at the present moment; remove: all of the film.
  enum class Action { set_keyframe, move_keyframe, delete_keyframe, length, turntable, remove };
  Action action;
  std::size_t keyframe = 0;
  /// Keyframe that set_keyframe renews; none: that of the present moment, or a new one.
  std::optional<std::size_t> chosen{};
  int frame = 0;                ///< to which the keyframe moves
  double seconds = 0, fps = 0;  ///< Length and rate of the film
  double turns = 1;             ///< Number of turns of the turntable
};
/// Asks for a file of the film: a video, or a zip archive of numbered pictures.
struct SaveFilm {
  int width, height;
  double tolerance;
  std::string format;  ///< one of film_formats
};
inline constexpr std::array film_formats{"webm", "mp4", "zip"};
/// Ends the film that is being saved, if there is one.
struct CancelFilm {};
/// Tells that the page has the file of a film.
struct TakeFilm {};
/// Asks for the arrays of a layer's file, and the times of a mesh. All of the file is read for it.
struct ListFile {
  std::size_t layer;
};
/// Asks for the names in a folder of this machine; empty: the program's working directory.
struct ListFolder {
  std::string folder;
};
/// Shows a file of this machine, or "builtin:NAME", in place of the scene.
struct OpenFile {
  std::string input;
};
/// Shows a file that was uploaded, or all files of its set if there is no name.
struct OpenUpload {
  int set;
  std::string name;
};
/// Asks for a file.
struct Save {
  enum class Kind { png, png_with_color_bar, exr, scene };
  Kind kind;
};

using Command =
    std::variant<Resize, Turn, Pan, Zoom, Roll, Center, ResetCamera, LookFrom, SetProjection,
                 SetTolerance, Edit, Undo, Redo, Suggest, CancelFit, ImportFunction, ExportFunction,
                 AskHistogram, AskThumbnail, Probe, AskSlice, Locate, DragHandle, ShowErrorMap,
                 ChooseComponent, ChooseArray, ChooseTime, SetTime, ShowFilmFrame, EditFilm,
                 SaveFilm, CancelFilm, TakeFilm, ListFile, ListFolder, OpenFile, OpenUpload, Save>;

/// Largest message of a page, in bytes: an imported color map with some ten thousand nodes.
inline constexpr std::size_t largest_message = std::size_t(2) << 20;
/// Largest edges of a picture, in pixels, and of a slice, in values.
inline constexpr int largest_edge = 8192, largest_slice_edge = 4096;

/// Parses a message. Throws Error with one line that names what is wrong. Any bytes are safe.
Command parse_command(std::string_view message);

}  // namespace pellucid::view
