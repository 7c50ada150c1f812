// SPDX-License-Identifier: Apache-2.0
//
// What changes with the time of the data and the moment of a film.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "pellucid/scene/error.h"
#include "scene_state.h"

namespace pellucid::view {

double SceneState::time() const {
  const std::vector<double>& all = times_.all();
  return description_.time ? *description_.time : all.empty() ? 0 : all.front();
}

SceneDescription SceneState::with_time() const {
  SceneDescription description = description_;
  if (!times_.all().empty()) description.time = time();
  return description;
}

bool SceneState::follows_time(std::size_t layer) const {
  return !times_.all().empty() && !times_.of(layer).empty();
}

void SceneState::set_time(double time) {
  if (times_.all().empty()) {
    throw Error("time: no data of the scene have steps without a time of their own");
  }
  SceneDescription next = description_;
  next.time = time;
  load(std::move(next));
  film_.reset();
}

const Animation& SceneState::film_length() const noexcept {
  return description_.animation ? *description_.animation : new_film_;
}

Animation SceneState::film_to_save() const {
  if (description_.animation) return *description_.animation;
  Animation film = default_animation(times_);
  if (!length_is_set_) return film;
  film.seconds = new_film_.seconds;
  film.fps = new_film_.fps;
  return film;
}

SceneDescription SceneState::film_base() const {
  SceneDescription base = description_;
  base.animation.reset();
  if (turntable_camera_) base.camera = turntable_camera_;
  return base;
}

SceneDescription SceneState::timed(SceneDescription description) const {
  if (!times_.all().empty()) {
    times_.set(description, description.time.value_or(times_.all().front()));
  }
  description.time.reset();
  description.animation.reset();
  return description;
}

SceneDescription SceneState::resolved_description() const {
  SceneDescription description = timed(description_);
  description.animation = description_.animation;
  return description;
}

void SceneState::load(SceneDescription next) {
  FrameLoader loader = make_loader();
  SceneDescription now = timed(next);
  const bool has_picture_behind = scene_.backdrop && now.backdrop.empty();
  Scene scene = loader.load(now, parallel_);
  if (has_picture_behind) scene.backdrop = scene_.backdrop;
  check_data(scene);
  check_method(scene);
  make_camera_frame(scene.camera, scene.size);
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    complete_description(scene.layers[i], next.layers[i]);
    use_matrices(next.layers[i]);
  }
  description_ = std::move(next);
  scene_ = std::move(scene);
}

Film SceneState::make_film(const Animation& animation) const {
  const SceneDescription base = timed(film_base());
  return {base, base, animation, times_};
}

FrameLoader SceneState::make_loader() const {
  return {timed(description_), scene_};
}

void SceneState::show_frame(int frame) {
  const int frames = frame_count(film_length());
  if (frame < 0 || frame >= frames) {
    throw Error(
        fmt::format("film: there is no frame {}; it has {}, counted from 0", frame, frames));
  }
  if (!description_.animation) {
    frame_ = frame;
    return;
  }
  const Animation& animation = *description_.animation;
  if (!film_) film_ = std::make_shared<const Film>(make_film(animation));
  SceneDescription next = film_->description(frame);
  next.animation = animation;
  times_.clear(next);
  const std::optional<double> time = film_->time(frame);
  next.time = time ? time : description_.time;
  const bool goes_on = frame != frame_;
  const bool moves_camera =
      animation.turntable || !animation.cameras.empty() || has_camera_tracks(animation);
  if (!moves_camera) next.camera = description_.camera;
  const std::optional<Camera> still = turntable_camera_ ? turntable_camera_ : description_.camera;
  load(std::move(next));
  if (animation.turntable) turntable_camera_ = still;
  frame_ = frame;
  // What was changed and is in no keyframe was seen to be so in the whole film.
  if (goes_on) keyed_ = with_time();
}

bool SceneState::has_chosen_time(const Animation& film) const {
  if (!(film.time || film.by_steps) || !description_.time) return false;
  const std::optional<double> shown = make_film(film).time(frame_);
  return shown && *shown != *description_.time;
}

Animation SceneState::film_with_motion() const {
  Animation film = film_length();
  if (!description_.animation) {
    // Without keyframes it shows each step. A time that was chosen is held instead.
    film.by_steps = times_.all().size() > 1 && time() == times_.all().front();
  } else if (has_chosen_time(film)) {
    const Film made = make_film(film);
    film = with_time_track(std::move(film), [&](int frame) { return *made.time(frame); });
  }
  if (film.turntable) film = with_turntable_keyframes(std::move(film), *film_base().camera);
  return film;
}

void SceneState::set_keyframe(std::optional<std::size_t> keyframe) {
  const Animation& length = film_length();
  const auto there = keyframe ? keyframe : keyframe_at(keyframes_of(length), frame_, length.fps);
  const double at =
      there ? moment_of(length, *there) : std::min(frame_ / length.fps, length.seconds);
  set_film(with_keyframe(film_with_motion(), at, with_time(), keyed_parts(keyed_)));
  keyed_ = with_time();
}

void SceneState::move_keyframe(std::size_t keyframe, int frame) {
  const Animation& film = film_length();
  set_film(with_keyframe_moved(film, keyframe, std::min(frame / film.fps, film.seconds)));
}

void SceneState::delete_keyframe(std::size_t keyframe) {
  Animation film = without_keyframe(film_length(), keyframe);
  if (has_motion(film)) return set_film(std::move(film));
  new_film_ = Animation{};
  if (length_is_set_) {
    new_film_.seconds = film.seconds;
    new_film_.fps = film.fps;
  }
  set_film(std::nullopt);
}

void SceneState::set_film_length(double seconds, double fps) {
  if (description_.animation) {
    set_film(with_length(*description_.animation, seconds, fps));
    length_is_set_ = true;
    return;
  }
  Animation film = new_film_;
  film.seconds = seconds;
  film.fps = fps;
  new_film_ = parse_animation(animation_to_json(film), "film");
  length_is_set_ = true;
  clamp_frame();
}

void SceneState::set_turntable(double turns) {
  Animation film = film_length();
  film.cameras.clear();
  film.is_closed = false;
  film.turntable = Turntable{turns, {}};
  frame_ = 0;
  set_film(std::move(film));
}

void SceneState::remove_film() {
  if (!description_.animation) return;
  new_film_ = Animation{};
  length_is_set_ = false;
  set_film(std::nullopt);
}

void SceneState::set_film(std::optional<Animation> film) {
  std::shared_ptr<const Film> made;
  if (film) {
    // The parser of scenes says what is wrong.
    film = parse_animation(animation_to_json(*film), "film");
    made = std::make_shared<const Film>(make_film(*film));
  }
  remember(description_, no_gesture);
  description_.animation = std::move(film);
  film_ = std::move(made);
  show_film();
}

void SceneState::show_film() {
  if (!description_.animation || !description_.animation->turntable) turntable_camera_.reset();
  clamp_frame();
  if (description_.animation) show_frame(frame_);
}

void SceneState::clamp_frame() {
  frame_ = std::clamp(frame_, 0, frame_count(film_length()) - 1);
}

}  // namespace pellucid::view
