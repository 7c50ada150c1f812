// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pellucid/io/animation.h"
#include "pellucid/io/scene_json.h"

namespace pellucid {

/// Times of the steps that the data of a scene have, found once for each of their sources.
class SceneTimes {
 public:
  /// Reads what the files say of their times. Throws Error.
  explicit SceneTimes(const SceneDescription& description);

  /// Returns the times of all data that have no time of their own in the scene, ascending and each
  /// once; empty: none has steps.
  const std::vector<double>& all() const noexcept { return all_; }
  /// Returns the unit of the times, as files write it; empty: none says one, or they differ.
  const std::string& unit() const noexcept { return unit_; }
  /// Returns how many more there are that no scene can name: beyond ±1e30.
  std::size_t left_out() const noexcept { return left_out_; }
  /// Returns those of one layer likewise.
  std::vector<double> of(std::size_t layer) const;
  /// Has such data read at a moment: at the step that is nearest to it (of two as near the
  /// earlier), or between two where their source has TimeBetween::linear. `description` has the
  /// sources of the one that the times are of.
  void set(SceneDescription& description, double moment) const;
  /// Takes the times of such data away again, so that they have none of their own.
  void clear(SceneDescription& description) const;

 private:
  std::vector<std::vector<std::vector<double>>> times_;  ///< times of each source of each layer
  std::vector<double> all_;
  std::string unit_;
  std::size_t left_out_ = 0;
};

/// Has a scene with a "time" read at it: writes the steps into its sources, and takes the key away.
/// Throws Error if none of them has steps.
void resolve_time(SceneDescription& description);

/// Gives the sources that have steps, and no time of their own, the time of the first one. Data
/// whose times cannot be listed stay as they are.
void set_first_step(SceneDescription& description);
/// Returns the time of a film's first frame. `times`, of its scene, are not empty.
double first_time(const Animation& film, const SceneTimes& times);
/// Has data that a film moves, which have no time yet, read at its first frame's.
void set_first_time(const Animation& film, SceneDescription& description);

/// Returns the film of a scene that has no animation: one frame for each time if its data have
/// several, at 10 frames per second; else a turntable of 5 s.
Animation default_animation(const SceneTimes& times);

/// The frames of an animated scene, as descriptions. They are made by the JSON of the scene: tracks
/// replace or add what their pointers name.
class Film {
 public:
  /// Takes the scene as its author wrote it, into which the tracks point, and `complete`: the same
  /// after complete_description(), so that what was chosen from the data stays the same in all
  /// frames; where a track changes a part of it, such as a layer's transfer function, all of this
  /// part is as written. Frames are made when they are asked for: what takes long for a long film
  /// is check(). Here the scenes at all keys are checked, and those of a few frames. Throws Error,
  /// which names the track or the frame.
  Film(const SceneDescription& written, const SceneDescription& complete,
       const Animation& animation, SceneTimes times);
  ~Film();
  Film(Film&&) noexcept;
  Film& operator=(Film&&) noexcept;

  /// Makes every frame once, to check it. Throws Error, which names the frame. Returns false where
  /// `ended`, which is asked every few frames if there is one, returns true.
  bool check(const std::function<bool()>& ended = {}) const;

  int frames() const noexcept { return frames_; }
  /// Returns the moment of a frame, counted from 0, in seconds of the film.
  double seconds(int frame) const noexcept { return frame / animation_.fps; }
  /// Returns the time of the data in a frame; none: it does not change.
  std::optional<double> time(int frame) const;
  /// Returns the scene of a frame. It leaves nothing open but what tracks do. Throws Error where
  /// values between two keys make no scene.
  SceneDescription description(int frame) const;

 private:
  struct Document;

  Animation animation_;
  SceneTimes times_;
  int frames_ = 0;
  std::unique_ptr<Document> document_;
  std::optional<CameraPath> path_;
};

/// Loads the scenes of a film one after the other, and keeps what does not change: layers whose
/// description stays, with all that renderers have made for them, and data whose sources stay.
class FrameLoader {
 public:
  /// Starts from the scene that `description` was loaded as.
  FrameLoader(const SceneDescription& description, const Scene& loaded);

  /// Throws Error.
  Scene load(const SceneDescription& description, const ParallelFor& parallel = {});

 private:
  std::vector<std::string> layers_, sources_;  ///< the JSON of the layers, and of their data
  Scene scene_;
};

/// Copies the function of a layer, its surfaces, its light and, if both have labels, their look.
void copy_look(const LayerDescription& from, LayerDescription& to);
/// Writes what was chosen of a layer by choose_for_all_steps() into a description of this layer
/// whose sources have options of their own.
void copy_choice(const LayerDescription& from, LayerDescription& to);

/// Functions that choose_for_all_steps() calls meanwhile; each may be empty.
struct StepsAsked {
  std::function<bool()> ended{};                   ///< is asked before each step: whether to end
  std::function<void(const std::string&)> note{};  ///< is told of a step that does not count
};

/// Chooses what the scene leaves to its data, such as the function, the surfaces and the range of a
/// layer whose data have steps, from all of these, or of many from `most_steps` evenly among them,
/// and writes it into the description. Each of these is read for that. Of volumes every second
/// value along each axis is looked at; the look is that which most steps would have. Functions of
/// meshes are those of the first step, laid over the range of the values at all. Of labels all
/// steps are read, so that each label has a color. A step that cannot be read does not count.
/// Channels of several variables stay as they are. Returns the layers that were changed; none where
/// it was ended. Throws Error.
std::vector<std::size_t> choose_for_all_steps(SceneDescription& description,
                                              const SceneTimes& times,
                                              const ParallelFor& parallel = {},
                                              const StepsAsked& asked = {});
inline constexpr std::size_t most_steps = 12;

}  // namespace pellucid
