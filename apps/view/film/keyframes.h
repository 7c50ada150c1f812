// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pellucid/io/film.h"
#include "view/command.h"

namespace pellucid::view {

/// Moment of a film at which the camera or other parts of the scene have a value of their own.
struct Keyframe {
  double at = 0;  ///< seconds
  bool has_camera = false;
  std::vector<std::string> targets{};  ///< Targets of the tracks with a key then: JSON pointers
};

/// Returns the keyframes of a film, ascending. Cameras without times count as evenly spaced.
std::vector<Keyframe> keyframes_of(const Animation& film);
/// Returns the moment of a keyframe. Throws Error if there is no such keyframe.
double moment_of(const Animation& film, std::size_t keyframe);
/// Returns the number of the keyframe that a frame shows: the nearest one within half a frame.
std::optional<std::size_t> keyframe_at(const std::vector<Keyframe>& keyframes, int frame,
                                       double fps);

/// Returns what a keyframe may hold besides the camera, by JSON pointer: "/time" where there is
/// one, "/clip", "/lights", and of each layer "visible", "transfer_function", "isosurfaces",
/// "slices", "shading" and "clip". What the scene lacks is null.
Json keyed_parts(const SceneDescription& scene);

/// Returns the film with the scene's camera and the values of all tracks at a moment; keys that are
/// there then are replaced. A part that differs from `last_parts`, which are keyed_parts() of the
/// keyframe before, gets a track: with the values of `last_parts` at all other keyframes. A
/// turntable gives way (with_turntable_keyframes()), but tracks that move parts of the camera do
/// not. `scene` has a camera.
Animation with_keyframe(Animation film, double at, const SceneDescription& scene,
                        const Json& last_parts);
/// Returns the film with a keyframe at another moment. Throws Error if there is no such keyframe,
/// if another one is there then, or if the moment is not in the film.
Animation with_keyframe_moved(Animation film, std::size_t keyframe, double at);
/// Returns the film without a keyframe. Throws Error if there is no such keyframe.
Animation without_keyframe(Animation film, std::size_t keyframe);
/// Returns the film with another length, its keys at the same parts of it.
Animation with_length(Animation film, double seconds, double fps);

/// Returns the film with a track of "/time" in the place of its `time` or its steps. The track
/// holds the film's times at the first and the last frame; of steps at the keyframes, if there are
/// any. `time_of` returns the time of a frame.
Animation with_time_track(Animation film, const std::function<double(int)>& time_of);
/// Returns the film with cameras at every quarter of its turntable, which make the same turn.
/// `start` is the camera of the first frame. Throws Error for more than 25 turns.
Animation with_turntable_keyframes(Animation film, const Camera& start);

/// Returns whether tracks move the camera, or parts of it.
bool has_camera_tracks(const Animation& film);
/// Returns whether something moves in a film: its frames may differ.
bool has_motion(const Animation& film);

}  // namespace pellucid::view
