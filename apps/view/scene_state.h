// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command.h"
#include "film/keyframes.h"
#include "pellucid/io/film.h"
#include "pellucid/io/scene_json.h"

namespace pellucid::view {

/// The scene that all pages look at, with its history and its film. Description and scene always
/// agree. Sources that follow the scene's time have none of their own in the description.
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
  /// Returns the description with a layer that leaves to its data what set_default_function() makes
  /// from them.
  SceneDescription with_open_function(std::size_t layer) const;
  /// Returns whether two layers have the same function, surfaces and light.
  static bool have_same_look(const LayerDescription& a, const LayerDescription& b);
  /// Replaces a layer's function, surfaces and light by those of `chosen`, which were chosen from
  /// all steps of its data: no step of the history, in which they take the old ones' place too.
  void take_choice(std::size_t layer, const LayerDescription& chosen);
  /// Replaces the scene's clips. Drags of one gesture are undone together.
  void set_clips(std::vector<Clip> clips, int gesture);
  /// Changes what is read for a layer, reads it, and forgets the history. `keeps_function`: whether
  /// the values mean the same as before; else the function is made anew, and isosurfaces go.
  void set_source(std::size_t layer, const std::function<void(LayerDescription&)>& change,
                  bool keeps_function);

  // scene_state_film.cpp:
  /// Returns the times of the steps that the scene's time chooses from, ascending; empty: none.
  const std::vector<double>& times() const noexcept { return times_.all(); }
  const SceneTimes& scene_times() const noexcept { return times_; }
  /// Returns the unit of these times, and how many are left out (SceneTimes).
  const std::string& times_unit() const noexcept { return times_.unit(); }
  std::size_t times_left_out() const noexcept { return times_.left_out(); }
  /// Returns the time of the data; 0 without steps.
  double time() const;
  /// Returns whether the data of a layer, or some of them, follow the scene's time.
  bool follows_time(std::size_t layer) const;
  /// Reads the data at another time: no step of the history. Throws Error if no data have steps.
  void set_time(double time);

  /// Returns the film that keyframes are added to: the scene's, or one in which nothing moves yet.
  const Animation& film_length() const noexcept;
  /// Returns the film that is saved: the scene's, or that of a scene without keyframes
  /// (default_animation()).
  Animation film_to_save() const;
  /// Returns the description with the times that are shown in its sources, and none of the scene.
  SceneDescription resolved_description() const;
  /// Returns a film of the scene. Throws Error.
  Film make_film(const Animation& animation) const;
  /// Returns what loads its frames, from the scene that is shown.
  FrameLoader make_loader() const;
  /// Returns the frame that the timeline stands at.
  int frame() const noexcept { return frame_; }
  /// Becomes the scene of a frame, to the bit that of Film: no step of the history. What no key
  /// says stays as it is. Throws Error if there is no such frame.
  void show_frame(int frame);
  /// Makes what is shown the keyframe of the present moment (with_keyframe()), or renews that of a
  /// number at its own moment, which need not be a frame's: a step of the history, which the
  /// changes below are, too. Throws Error, as they do.
  void set_keyframe(std::optional<std::size_t> keyframe = {});
  void move_keyframe(std::size_t keyframe, int frame);
  /// Deletes a keyframe, and with the last one the film but a length that was chosen.
  void delete_keyframe(std::size_t keyframe);
  /// Sets the length of the film. Keyframes stay at the same parts of it.
  void set_film_length(double seconds, double fps);
  /// Has the camera go around from where it is, in place of its keyframes.
  void set_turntable(double turns);
  /// Removes the film and its length.
  void remove_film();

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
  /// Returns that as a scene file, with the film of a length that was chosen even if nothing of it
  /// has keyframes. Throws Error if data are arrays.
  std::string saved() const;
  /// Returns the layer's function in JSON, by which it is known again; empty if there is none.
  std::string function_text(std::size_t layer) const;
  /// Returns the number of the layer, or throws Error if there is none.
  std::size_t checked_layer(std::size_t layer) const;

 private:
  static constexpr int no_gesture = -1;
  struct Step {
    SceneDescription description, keyed;
  };

  /// Makes the scene of another description, with the data of this one and new looks of some
  /// layers.
  void become(SceneDescription next, std::size_t first, std::size_t count);
  /// Becomes `next`, and remembers the description before it unless the gesture goes on.
  void take_step(SceneDescription next, std::size_t first, std::size_t count, int gesture);
  void step(std::vector<Step>& from, std::vector<Step>& to);
  /// Adds the description to the history, unless the gesture goes on.
  void remember(SceneDescription before, int gesture);
  /// Writes Gaussians as matrices, so that a page edits one form. Their functions stay the same to
  /// the bit.
  static void use_matrices(LayerDescription& layer);

  /// Returns the description with the time of the data, also where it is the first one.
  SceneDescription with_time() const;
  /// Returns the description with the scene's time in its sources, and without a film.
  SceneDescription timed(SceneDescription description) const;
  /// Becomes a scene of the same sources at other times, or with other looks.
  void load(SceneDescription next);
  /// Returns the scene that frames are made from: with the camera of a turntable's start.
  SceneDescription film_base() const;
  void set_film(std::optional<Animation> film);
  /// Returns whether the data are shown at another time than a film that moves them evenly says.
  bool has_chosen_time(const Animation& film) const;
  /// Returns the film that a keyframe is added to, in which what moved without keyframes goes on:
  /// steps of time stay until a time is chosen, and a turntable becomes keyframes.
  Animation film_with_motion() const;
  /// Shows the frame of the timeline's moment, or the nearest one that the film has.
  void show_film();
  void clamp_frame();

  SceneDescription description_;
  Scene scene_;
  ParallelFor parallel_;
  SceneTimes times_;                  ///< Times of the sources that follow the scene's time
  std::shared_ptr<const Film> film_;  ///< Film of the animation; null: not made yet
  Animation new_film_;                ///< without keyframes
  bool length_is_set_ = false;        ///< True once the user chose a length
  int frame_ = 0;
  std::optional<Camera> turntable_camera_;  ///< Camera of a turntable's start, once turned
  SceneDescription keyed_;                  ///< whose keyed_parts() are those of the last keyframe
  std::vector<Step> undone_by_, redone_by_;
  int last_gesture_ = -1;
  std::filesystem::path temporary_;  ///< empty: there is none
};

}  // namespace pellucid::view
