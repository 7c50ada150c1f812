// SPDX-License-Identifier: Apache-2.0
#include "film_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <future>
#include <utility>

#include "arguments/parse.h"
#include "pellucid/base/version.h"
#include "pellucid/cpu/threads.h"
#include "pellucid/scene/view_camera.h"
#include "render/progress.h"

namespace pellucid::cli {

namespace {

/// Parses "0:2.5", the times of the first and the last frame.
std::array<double, 2> parse_times(const std::string& text) {
  std::array<double, 2> times{};
  const char* const end = text.data() + text.size();
  const auto [colon, bad_first] = std::from_chars(text.data(), end, times[0]);
  const bool has_last = colon != end && *colon == ':';
  const auto [rest, bad_last] = std::from_chars(has_last ? colon + 1 : end, end, times[1]);
  const bool is_good = bad_first == std::errc{} && bad_last == std::errc{} && rest == end;
  if (is_good && std::isfinite(times[0]) && std::isfinite(times[1])) return times;
  throw UsageError(fmt::format("--times '{}': expected FIRST:LAST, as 0:2.5", text));
}

/// Returns the film that the scene has, or else a default one, with the arguments over it.
Animation animation_of(const AnimateArguments& arguments, const SceneDescription& scene,
                       const SceneTimes& times) {
  Animation animation = scene.animation ? *scene.animation : default_animation(times);
  if (!arguments.times.empty()) {
    animation.time = parse_times(arguments.times);
    animation.by_steps = false;
    if (!scene.animation && !arguments.turns) animation.turntable.reset();
  }
  if (arguments.turns) {
    if (!animation.cameras.empty()) {
      throw UsageError("--turns: the scene's animation has cameras of its own; leave it out");
    }
    if (!animation.turntable) animation.turntable.emplace();
    animation.turntable->turns = *arguments.turns;
  }
  // Films of steps keep a frame for each step at another speed.
  const bool is_of_steps = !scene.animation && animation.by_steps;
  if (is_of_steps && arguments.scene.mesh.time_between == "linear") {
    animation.by_steps = false;
    animation.time = {times.all().front(), times.all().back()};
  }
  const double steps = animation.seconds * animation.fps;
  if (arguments.fps) animation.fps = *arguments.fps;
  if (arguments.seconds) {
    animation.seconds = *arguments.seconds;
  } else if (arguments.frames) {
    animation.seconds = *arguments.frames / animation.fps;
  } else if (is_of_steps) {
    animation.seconds = steps / animation.fps;
  }
  return animation;
}

/// Returns the scene's camera, moved until it holds the whole box of the data.
Camera camera_around(const Scene& scene) {
  const CameraFrame<double> frame = make_camera_frame(scene.camera, scene.size);
  return camera_along(frame.forward, normalized(frame.up), world_corners(scene), scene.size);
}

/// Copies what was chosen from all steps; sources have notes of their own.
void copy_choice(const LayerDescription& from, LayerDescription& to) {
  to.transfer_function = from.transfer_function;
  to.function_change = from.function_change;
  to.shading = from.shading;
  to.isosurfaces = from.isosurfaces;
  to.look = from.look;
}

/// Returns "3 min 20 s".
std::string duration_text(double seconds) {
  const long whole = std::lround(seconds);
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

}  // namespace

FilmRun::FilmRun(const AnimateArguments& arguments, FilmShare share)
    : arguments_(arguments),
      share_(share),
      files_(arguments.output),
      parallel_(parallel_for(arguments.scene.threads > 0 ? arguments.scene.threads
                                                         : default_thread_count())) {}

void FilmRun::load() {
  const RenderArguments& scene = arguments_.scene;
  std::optional<SceneTimes> times;
  SceneDescription written;
  prepared_ = prepare(scene, [&](SceneRequest& request) {
    if (request.description.integration.relative_tolerance) {
      throw UsageError(
          "the scene's tolerance is a share of one picture's range; give --tolerance a number, "
          "which all frames keep");
    }
    SceneDescription& asked = request.prepared.description;
    const auto& given = request.description.animation;
    if (!arguments_.times.empty() || (given && given->moves_data())) {
      request.description.time.reset();
      asked.time.reset();
    }
    resolve_time(request.description);
    resolve_time(asked);
    times.emplace(request.description);
    animation_ = animation_of(arguments_, request.description, *times);
    written = request.description;
    if (!animation_.moves_data() || times->all().empty()) return;
    const double first = animation_.time ? (*animation_.time)[0] : times->all().front();
    times->set(asked, first);
    times->set(request.description, first);
    for (const std::size_t i : choose_for_all_steps(asked, *times, parallel_)) {
      copy_choice(asked.layers[i], request.description.layers[i]);
    }
  });
  if (animation_.moves_data()) {
    // What moves or grows leaves the place of its first step, but not the box of the data.
    place_camera(scene, prepared_, camera_around);
  } else {
    place_camera(scene, prepared_);
  }
  notes_ = prepared_.import_notes;
  if (prepared_.look && !prepared_.look->name.empty()) notes_.push_back(look_line(prepared_));
  film_.emplace(written, prepared_.description, animation_, *std::move(times));
  loader_.emplace(prepared_.description, prepared_.scene);
}

std::string FilmRun::stamp_of(const SceneDescription& description) const {
  return fmt::format("pellucid {}\n{}{}{}", PELLUCID_VERSION_STRING, data_stamp(description),
                     scene_to_json(description), options_text());
}

std::string FilmRun::options_text() const {
  const RenderArguments& scene = arguments_.scene;
  return fmt::format("background {}; color bar {} '{}'", scene.background, scene.wants_color_bar(),
                     scene.color_bar_title);
}

std::optional<FilmRun::Loaded> FilmRun::load_next(int frame) {
  for (; frame < film_->frames(); ++frame) {
    if (!share_.has(frame)) continue;
    SceneDescription description = film_->description(frame);
    std::string stamp = stamp_of(description);
    if (files_.has(frame, stamp)) {
      ++kept_;
      continue;
    }
    Scene scene = loader_->load(description, parallel_);
    return Loaded{frame, std::move(description), std::move(stamp), std::move(scene)};
  }
  return std::nullopt;
}

void FilmRun::render_all() {
  const InterruptGuard guard;
  ProgressLine progress(!arguments_.scene.quiet);
  const int frames = share_.count(film_->frames());
  const auto start = std::chrono::steady_clock::now();
  std::optional<Loaded> next = load_next(0);
  while (next) {
    const Loaded now = *std::move(next);
    // The next step is read while this one is rendered.
    std::future<std::optional<Loaded>> ahead =
        std::async(std::launch::async, [&] { return load_next(now.frame + 1); });
    render(now, [&](double share_done) {
      const double seconds =
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      const double done = made_ + share_done;
      std::string text = fmt::format("frame {} of {}", made_ + kept_ + 1, frames);
      if (made_ > 0) {
        text += fmt::format(", {} left", duration_text(seconds / done * (frames - kept_ - done)));
      }
      progress.show(text);
    });
    ++made_;
    next = ahead.get();
  }
  progress.clear();
}

void FilmRun::render(const Loaded& now, const std::function<void(double)>& show) {
  RenderOptions options;
  options.machine.threads = arguments_.scene.threads;
  const bool is_exr = files_.picture(0).extension() == ".exr";
  options.outputs.depth = is_exr;
  options.outputs.error = is_exr && prepared_.knows_its_error(arguments_.scene);
  options.monitor.progress = [&](double share_done) {
    show(share_done);
    return !InterruptGuard::interrupted();
  };
  RenderResult result = unless_interrupted([&] { return renderer_.render(now.scene, options); });
  largest_error_ = std::max(largest_error_, result.report.largest_error);
  if (result.report.pixels_over_tolerance > 0) over_.push_back(now.frame);
  prepared_.description = now.description;
  prepared_.scene = now.scene;
  add_metadata(arguments_.scene, prepared_, result.report, result.image);
  Image& image = result.image;
  if (!is_exr && arguments_.scene.wants_color_bar()) {
    std::vector<std::string> notes;
    if (auto drawn = with_wanted_color_bars(arguments_.scene, prepared_, image, notes)) {
      image = *std::move(drawn);
    }
    if (made_ == 0) notes_.insert(notes_.end(), notes.begin(), notes.end());
  }
  files_.write(now.frame, image, now.stamp, shown_background(now.description));
}

void FilmRun::tell(const std::string& path) const {
  if (arguments_.scene.quiet) return;
  for (const std::string& note : notes_) print_note(note);
  const Integration& integration = prepared_.scene.integration;
  std::string text = fmt::format("{}: {} frames, {:.3g} s", path, film_->frames(),
                                 film_->frames() / animation_.fps);
  if (kept_ > 0) text += fmt::format("; {} were there", kept_);
  if (made_ > 0 && prepared_.knows_its_error(arguments_.scene)) {
    text += fmt::format("; largest error of a pixel {:.3g}, tolerance {:.3g}", largest_error_,
                        integration.tolerance);
  }
  print_note(text);
}

}  // namespace pellucid::cli
