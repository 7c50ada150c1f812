// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command.h"
#include "pellucid/io/scene_json.h"

namespace pellucid::view {

/// The scene that all pages look at, with its history. Description and scene always agree.
class SceneState {
 public:
  /// `description` is complete (complete_description()), and `scene` was made from it.
  SceneState(SceneDescription description, Scene scene, ParallelFor parallel);

  const SceneDescription& description() const noexcept { return description_; }
  const Scene& scene() const noexcept { return scene_; }

  /// Replaces the camera, unless it makes no rays (make_camera_frame()).
  void set_camera(const Camera& camera);
  void set_size(ImageSize size);
  void set_tolerance(double tolerance);

  /// Applies an edit. Throws Error, and leaves everything as it was, if the key is not editable or
  /// the value does not suit it: what parse_scene(), make_scene() and render() would refuse.
  ///
  /// - of the scene: "clip", "lights", "background"
  /// - of a layer: "visible", "transfer_function", "shading", "gradient_opacity", "clip",
  ///   "projection", "isosurfaces", "slices" and "colors", the looks of labels
  ///
  /// In a value, a color may be a text "#rrggbb" in place of linear numbers.
  void edit(const Edit& edit);
  /// Replaces a layer's function and look, as a step of the history.
  void set_look(std::size_t layer, const LookDescription& look);
  /// Replaces a layer's function by Gaussians, unlit: of several variables light takes many times
  /// as long.
  void set_gaussians(std::size_t layer, MultivariateDescription gaussians);
  /// Replaces a layer's Gaussians, that were there first, by better ones: no step of the history,
  /// in which the better ones take their place too.
  void refine_gaussians(std::size_t layer, MultivariateDescription gaussians);
  /// Replaces a layer's function by the one that is made from its data, as a step of the history.
  void set_default_function(std::size_t layer);
  /// Replaces the scene's clips. Drags of one gesture are undone together.
  void set_clips(std::vector<Clip> clips, int gesture);
  /// Changes what is read for a layer, reads it, and forgets the history. `keeps_function`: whether
  /// the values mean the same as before; else the function is made anew, and isosurfaces go.
  void set_source(std::size_t layer, const std::function<void(LayerDescription&)>& change,
                  bool keeps_function);

  bool can_undo() const noexcept { return !undone_by_.empty(); }
  bool can_redo() const noexcept { return !redone_by_.empty(); }
  /// Take back the last edit, or make it again. Camera, size and tolerance stay as they are.
  void undo();
  void redo();

  /// Names a folder of data that is gone when they are not shown any more.
  void set_temporary_folder(std::filesystem::path folder) { temporary_ = std::move(folder); }
  bool has_temporary_folder() const noexcept { return !temporary_.empty(); }
  /// Returns the description with absolute paths; those in the temporary folder are relative to it.
  SceneDescription portable_description() const;
  /// Returns that as a scene file. Throws Error if data are arrays.
  std::string saved() const;
  /// Returns the layer's function in JSON, by which it is known again; empty if there is none.
  std::string function_text(std::size_t layer) const;
  /// Returns the number of the layer, or throws Error if there is none.
  std::size_t checked_layer(std::size_t layer) const;

 private:
  /// Makes the scene of another description, with the data of this one and new looks of some
  /// layers.
  void become(SceneDescription next, std::size_t first, std::size_t count);
  /// Becomes `next`, and remembers the description before it unless the gesture goes on.
  void take_step(SceneDescription next, std::size_t first, std::size_t count, int gesture);
  void step(std::vector<SceneDescription>& from, std::vector<SceneDescription>& to);

  SceneDescription description_;
  Scene scene_;
  ParallelFor parallel_;
  std::vector<SceneDescription> undone_by_, redone_by_;
  int last_gesture_ = -1;
  std::filesystem::path temporary_;  ///< empty: there is none
};

}  // namespace pellucid::view
