// SPDX-License-Identifier: Apache-2.0
#include "keyframes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "pellucid/scene/error.h"

namespace pellucid::view {

namespace {

using Pointer = Json::json_pointer;

/// Parts of a layer that keyframes hold, and what stands for one that is missing.
struct Part {
  const char* key;
  const char* missing;
};
constexpr std::array layer_parts{Part{"visible", "true"},   Part{"transfer_function", "null"},
                                 Part{"isosurfaces", "[]"}, Part{"slices", "[]"},
                                 Part{"shading", "null"},   Part{"clip", "[]"}};
constexpr std::array scene_parts{Part{"time", "null"}, Part{"clip", "[]"}, Part{"lights", "null"}};
constexpr std::string_view camera_target = "/camera";

/// Returns whether two moments are one: a millionth of a second apart or less. Those of cameras are
/// optional, but given here.
bool is_same(double a, double b) {
  return std::abs(a - b) <= 1e-6;
}
bool is_same(const std::optional<double>& a, const std::optional<double>& b) {
  return is_same(*a, *b);
}

/// Returns when the cameras of a film are reached, which without times is taken as even.
std::vector<double> camera_moments(const Animation& film) {
  std::vector<double> moments;
  const std::size_t count = film.cameras.size();
  const std::size_t ways = film.is_closed ? count : std::max<std::size_t>(count, 2) - 1;
  for (std::size_t i = 0; i < count; ++i) {
    moments.push_back(film.cameras[i].at.value_or(film.seconds * static_cast<double>(i) /
                                                  static_cast<double>(ways)));
  }
  return moments;
}

void give_cameras_times(Animation& film) {
  const std::vector<double> moments = camera_moments(film);
  for (std::size_t i = 0; i < moments.size(); ++i) film.cameras[i].at = moments[i];
}

Keyframe& keyframe_of(std::vector<Keyframe>& keyframes, double at) {
  const auto found = std::ranges::find_if(
      keyframes, [&](const Keyframe& keyframe) { return is_same(keyframe.at, at); });
  if (found != keyframes.end()) return *found;
  return keyframes.emplace_back(Keyframe{at});
}

/// Puts a key at its place in time, in the place of one that is there then.
template <class Key>
void put_key(std::vector<Key>& keys, Key key) {
  std::erase_if(keys, [&](const Key& other) { return is_same(other.at, key.at); });
  const auto behind =
      std::ranges::find_if(keys, [&](const Key& other) { return other.at > key.at; });
  keys.insert(behind, std::move(key));
}

/// Returns whether one of two pointers lies in the other, or they are the same.
bool overlap(std::string_view a, std::string_view b) {
  if (a.size() > b.size()) std::swap(a, b);
  return b.starts_with(a) && (b.size() == a.size() || b[a.size()] == '/');
}

void add_parts(const Json& object, const std::string& place, const Part& part, Json& parts) {
  const auto found = object.find(part.key);
  Json value = found != object.end() ? *found : Json::parse(part.missing);
  std::string target = place + part.key;
  if (target != time_target || !value.is_null()) parts[std::move(target)] = std::move(value);
}

/// Returns the document of a scene, in which what is missing and can be keyed has its default.
Json document_of(const SceneDescription& scene) {
  SceneDescription still = scene;
  still.animation.reset();
  return Json::parse(scene_to_json(still));
}

Json parts_of(const Json& document) {
  Json parts = Json::object();
  for (const Part& part : scene_parts) add_parts(document, "/", part, parts);
  const Json& layers = document.at("layers");
  for (std::size_t i = 0; i < layers.size(); ++i) {
    for (const Part& part : layer_parts) {
      add_parts(layers[i], fmt::format("/layers/{}/", i), part, parts);
    }
  }
  return parts;
}

/// Returns what a target has now, null for a part that the scene lacks; none: there is no such
/// target.
std::optional<Json> value_at(const Json& document, const Json& parts, const std::string& target) {
  if (const auto part = parts.find(target); part != parts.end()) return *part;
  const Pointer pointer(target);
  if (document.contains(pointer)) return document.at(pointer);
  return std::nullopt;
}

}  // namespace

std::vector<Keyframe> keyframes_of(const Animation& film) {
  std::vector<Keyframe> keyframes;
  for (const double at : camera_moments(film)) keyframe_of(keyframes, at).has_camera = true;
  for (const AnimationTrack& track : film.tracks) {
    for (const AnimationTrack::Key& key : track.keys) {
      keyframe_of(keyframes, key.at).targets.push_back(track.target);
    }
  }
  std::ranges::sort(keyframes, {}, &Keyframe::at);
  return keyframes;
}

double moment_of(const Animation& film, std::size_t keyframe) {
  const std::vector<Keyframe> keyframes = keyframes_of(film);
  if (keyframe < keyframes.size()) return keyframes[keyframe].at;
  throw Error(
      fmt::format("keyframe {}: there are {} keyframes only", keyframe + 1, keyframes.size()));
}

std::optional<std::size_t> keyframe_at(const std::vector<Keyframe>& keyframes, int frame,
                                       double fps) {
  std::optional<std::size_t> nearest;
  double distance = 0.5;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const double off = std::abs(keyframes[i].at * fps - frame);
    if (off >= distance) continue;
    distance = off;
    nearest = i;
  }
  return nearest;
}

Json keyed_parts(const SceneDescription& scene) {
  return parts_of(document_of(scene));
}

Animation with_keyframe(Animation film, double at, const SceneDescription& scene,
                        const Json& last_parts) {
  std::vector<double> others;
  for (const Keyframe& keyframe : keyframes_of(film)) {
    if (!is_same(keyframe.at, at)) others.push_back(keyframe.at);
  }
  film.turntable.reset();
  give_cameras_times(film);
  if (!film.cameras.empty() || !has_camera_tracks(film))
    put_key(film.cameras, CameraKey{*scene.camera, at});
  const Json document = document_of(scene);
  const Json parts = parts_of(document);
  for (AnimationTrack& track : film.tracks) {
    const std::optional<Json> value = value_at(document, parts, track.target);
    if (value) put_key(track.keys, AnimationTrack::Key{at, value->dump()});
  }
  for (const auto& part : parts.items()) {
    const std::string& target = part.key();
    const auto last = last_parts.find(target);
    if (others.empty() || last == last_parts.end() || *last == part.value()) continue;
    if (target == time_target && film.moves_data()) continue;
    if (std::ranges::any_of(film.tracks, [&](const AnimationTrack& track) {
          return overlap(track.target, target);
        })) {
      continue;
    }
    AnimationTrack track{target, Easing::linear, {}};
    for (const double moment : others) track.keys.push_back({moment, last->dump()});
    put_key(track.keys, AnimationTrack::Key{at, part.value().dump()});
    film.tracks.push_back(std::move(track));
  }
  return film;
}

Animation with_keyframe_moved(Animation film, std::size_t keyframe, double at) {
  const double from = moment_of(film, keyframe);
  if (!(at >= 0 && at <= film.seconds)) {
    throw Error(fmt::format("keyframe: {} s is not in the film, which has {} s", at, film.seconds));
  }
  if (is_same(from, at)) return film;
  for (const Keyframe& other : keyframes_of(film)) {
    if (is_same(other.at, at)) {
      throw Error(
          fmt::format("keyframe: another one is at {:.4g} s; delete it, or choose another "
                      "moment",
                      at));
    }
  }
  give_cameras_times(film);
  const auto move = [&](auto& keys) {
    const auto found =
        std::ranges::find_if(keys, [&](const auto& key) { return is_same(key.at, from); });
    if (found == keys.end()) return;
    auto moved = *found;
    keys.erase(found);
    moved.at = at;
    put_key(keys, std::move(moved));
  };
  move(film.cameras);
  for (AnimationTrack& track : film.tracks) move(track.keys);
  return film;
}

Animation without_keyframe(Animation film, std::size_t keyframe) {
  const double at = moment_of(film, keyframe);
  give_cameras_times(film);
  const auto is_then = [&](const auto& key) { return is_same(key.at, at); };
  std::erase_if(film.cameras, is_then);
  for (AnimationTrack& track : film.tracks) std::erase_if(track.keys, is_then);
  std::erase_if(film.tracks, [](const AnimationTrack& track) { return track.keys.empty(); });
  return film;
}

Animation with_length(Animation film, double seconds, double fps) {
  const double factor = seconds / film.seconds;
  for (CameraKey& key : film.cameras) {
    if (key.at) key.at = std::min(*key.at * factor, seconds);
  }
  for (AnimationTrack& track : film.tracks) {
    for (AnimationTrack::Key& key : track.keys) key.at *= factor;
  }
  film.seconds = seconds;
  film.fps = fps;
  return film;
}

Animation with_time_track(Animation film, const std::function<double(int)>& time_of) {
  const int last = frame_count(film) - 1;
  AnimationTrack track{time_target, Easing::linear, {}};
  const auto put = [&](double at, int frame) {
    put_key(track.keys, AnimationTrack::Key{at, Json(time_of(frame)).dump()});
  };
  const std::vector<Keyframe> keyframes = keyframes_of(film);
  if (film.by_steps && !keyframes.empty()) {
    for (const Keyframe& keyframe : keyframes) {
      put(keyframe.at, std::min(static_cast<int>(std::lround(keyframe.at * film.fps)), last));
    }
  } else {
    put(0, 0);
    put(last / film.fps, last);
  }
  film.tracks.push_back(std::move(track));
  film.time.reset();
  film.by_steps = false;
  return film;
}

Animation with_turntable_keyframes(Animation film, const Camera& start) {
  constexpr double most_turns = 25;
  const Turntable turntable = *std::exchange(film.turntable, std::nullopt);
  const double quarters = std::ceil(4 * std::abs(turntable.turns) - 1e-9);
  if (quarters > 4 * most_turns) {
    throw Error(fmt::format(
        "keyframe: the film's turntable turns {} times; with keyframes {} turns are the "
        "most, as each has four",
        turntable.turns, most_turns));
  }
  // Turntables take equal angles from frame to frame, and a turn ends with the frame after the
  // last.
  const double turns_a_second = turntable.turns * film.fps / frame_count(film);
  const int count = std::max(1, static_cast<int>(quarters));
  for (int i = 0; i <= count; ++i) {
    const double at = film.seconds * i / count;
    film.cameras.push_back({turned_camera(start, 360 * turns_a_second * at, turntable.axis), at});
  }
  return film;
}

bool has_camera_tracks(const Animation& film) {
  return std::ranges::any_of(film.tracks, [](const AnimationTrack& track) {
    return overlap(track.target, camera_target);
  });
}

bool has_motion(const Animation& film) {
  return film.turntable || film.moves_data() || !film.cameras.empty() || !film.tracks.empty();
}

}  // namespace pellucid::view
