// SPDX-License-Identifier: Apache-2.0
#include "film_run.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
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
                                                         : default_thread_count())) {
  files_.hold(share.is_all() ? FilmFiles::Holder::alone : FilmFiles::Holder::beside_others);
}

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
    const double first = first_time(animation_, *times);
    times->set(asked, first);
    times->set(request.description, first);
    const StepsAsked tell{{}, [this](const std::string& note) { notes_.push_back(note); }};
    for (const std::size_t i : choose_for_all_steps(asked, *times, parallel_, tell)) {
      copy_choice(asked.layers[i], request.description.layers[i]);
    }
  });
  if (animation_.moves_data()) {
    // What moves or grows leaves the place of its first step, but not the box of the data.
    place_camera(scene, prepared_, camera_around);
  } else {
    place_camera(scene, prepared_);
  }
  notes_.insert(notes_.end(), prepared_.import_notes.begin(), prepared_.import_notes.end());
  if (prepared_.look && !prepared_.look->name.empty()) notes_.push_back(look_line(prepared_));
  if (times->left_out() > 0) {
    notes_.push_back(
        fmt::format("steps left out: {}, whose times are beyond ±1e30, the largest "
                    "that a scene can name",
                    times->left_out()));
  }
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

void FilmRun::render_all() {
  const InterruptGuard guard;
  // Errors come before hours are spent on the frames in front of them.
  files_.check_size(prepared_.scene.size);
  if (!film_->check(InterruptGuard::interrupted)) InterruptGuard::check();
  ProgressLine progress(!arguments_.scene.quiet);
  const bool is_exr = files_.picture(0).extension() == ".exr";
  RenderOptions options;
  options.machine.threads = arguments_.scene.threads;
  options.outputs.depth = is_exr;
  options.outputs.error = is_exr && prepared_.knows_its_error(arguments_.scene);
  view::FilmFrames::Tasks tasks;
  tasks.is_wanted = [this](int frame) { return share_.has(frame); };
  tasks.frames = share_.count(film_->frames());
  tasks.made_from = [this](const SceneDescription& description) { return stamp_of(description); };
  tasks.progress = [&](const view::FilmProgress& now) {
    std::string text = fmt::format("frame {} of {}", now.frame, now.frames);
    if (now.seconds_left) text += fmt::format(", {} left", duration_text(*now.seconds_left));
    progress.show(text);
    return !InterruptGuard::interrupted();
  };
  tasks.rendered = [this](const view::FilmFrame& frame, RenderResult& result) {
    complete(frame, result);
  };
  frames_.emplace(*film_, files_, *loader_, parallel_, std::move(options), std::move(tasks));
  unless_interrupted([&] { frames_->render(); });
  progress.clear();
}

void FilmRun::complete(const view::FilmFrame& frame, RenderResult& result) {
  prepared_.description = frame.description;
  prepared_.scene = frame.scene;
  add_metadata(arguments_.scene, prepared_, result.report, result.image);
  const bool is_exr = files_.picture(0).extension() == ".exr";
  if (is_exr || !arguments_.scene.wants_color_bar()) return;
  std::vector<std::string> notes;
  if (auto drawn = with_wanted_color_bars(arguments_.scene, prepared_, result.image, notes)) {
    result.image = *std::move(drawn);
  }
  if (frames_->made() == 0) notes_.insert(notes_.end(), notes.begin(), notes.end());
}

void FilmRun::tell(const std::string& path) const {
  if (arguments_.scene.quiet) return;
  for (const std::string& note : notes_) print_note(note);
  const Integration& integration = prepared_.scene.integration;
  const int frames = film_->frames(), own = share_.count(frames);
  std::string text =
      fmt::format("{}: {}{} frames, {:.3g} s", path,
                  own == frames ? "" : fmt::format("{} of ", own), frames, frames / animation_.fps);
  if (frames_->kept() > 0) text += fmt::format("; {} were there", frames_->kept());
  if (frames_->made() > 0 && prepared_.knows_its_error(arguments_.scene)) {
    text += fmt::format("; largest error of a pixel {:.3g}, tolerance {:.3g}",
                        frames_->largest_error(), integration.tolerance);
  }
  print_note(text);
}

}  // namespace pellucid::cli
