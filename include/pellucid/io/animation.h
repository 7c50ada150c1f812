// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "pellucid/scene/camera_path.h"

namespace pellucid {

/// Way of a value from one key to the next: evenly, slowly at both ends (3u² - 2u³), or not at
/// all until the next key is there.
enum class Easing { linear, smooth, hold };
inline constexpr const char* easing_names[] = {"linear", "smooth", "hold"};

/// A camera that goes around what it looks at, at one speed.
struct Turntable {
  double turns = 1;                    ///< negative: the other way
  std::optional<Vec3<double>> axis{};  ///< none: the camera's upward direction
};

/// A part of a scene that changes.
struct AnimationTrack {
  struct Key {
    double at = 0;      ///< seconds
    std::string value;  ///< JSON
  };

  std::string target;  ///< JSON pointer into the scene: "/layers/0/isosurfaces/0/value"
  Easing easing = Easing::linear;
  std::vector<Key> keys;  ///< one at least, in the order of time
};

/// Changes of a scene in time, as the key "animation" of a scene says; docs/reference/scene.md
/// describes it.
struct Animation {
  double seconds = 5;  ///< length of the film
  double fps = 24;     ///< frames per second
  std::optional<Turntable> turntable;
  std::vector<CameraKey> cameras;  ///< keys of a CameraPath; empty: the scene's camera
  bool is_closed = false;          ///< True if that path returns to its first camera.
  /// Times of the data at the first and at the last frame, between which they go evenly; none: they
  /// do not change.
  std::optional<std::array<double, 2>> time;
  /// Instead, whether the data go from step to step, each of which is shown equally long.
  bool by_steps = false;
  std::vector<AnimationTrack> tracks;

  /// Returns whether the data change in time: by `time`, by steps, or by a track of "/time".
  bool moves_data() const noexcept;
};

/// Target of a track that moves the data, as `time` does evenly.
inline constexpr const char* time_target = "/time";

inline constexpr int most_frames = 1'000'000;

/// Returns the number of frames, 1 to most_frames: seconds · fps, rounded.
int frame_count(const Animation& animation);

}  // namespace pellucid
