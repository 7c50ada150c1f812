// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arguments/overwriting.h"
#include "arguments/parse.h"
#include "commands.h"
#include "pellucid/base/version.h"
#include "pellucid/cluster/communicator.h"
#include "pellucid/cpu/renderer.h"
#include "pellucid/cpu/threads.h"
#include "pellucid/io/film.h"
#include "pellucid/io/film_files.h"
#include "pellucid/io/image_files.h"
#include "render/progress.h"
#include "render/render.h"
#include "render/tolerance.h"
#include "share.h"

namespace pellucid::cli {

namespace {

struct AnimateArguments {
  RenderArguments scene;
  std::string output, times;
  std::optional<double> seconds, fps, turns;
  std::optional<int> frames;
  bool keeps_frames = false;
  std::string part;
  bool ranks = false;
};

/// Throws UsageError for what frames of a film cannot have.
void refuse_arguments(const AnimateArguments& arguments) {
  const RenderArguments& scene = arguments.scene;
  const std::pair<const char*, bool> given[] = {
      {"--reference", scene.reference},
      {"--strict", scene.strict},
      {"--device", !scene.device.empty() && scene.device != "cpu"},
      {"--backdrop", !scene.backdrop.empty()}};
  for (const auto& [argument, is_given] : given) {
    if (is_given)
      throw UsageError(fmt::format("{}: is of single pictures; leave it out", argument));
  }
  if (scene.tolerance && parse_picture_tolerance("--tolerance", *scene.tolerance).is_share) {
    throw UsageError(
        fmt::format("--tolerance {}: is a share of one picture's range; give a number, which all "
                    "frames keep",
                    *scene.tolerance));
  }
}

void check(const AnimateArguments& arguments) {
  const RenderArguments& scene = arguments.scene;
  if (arguments.output.empty()) {
    throw UsageError(
        "nothing to write; give -o FILE.webm, FILE.mp4 or FRAMES/%04d.png (see 'pellucid animate "
        "--help')");
  }
  if (source_text(scene).empty()) {
    throw UsageError("no input; give INPUT, --channel or --labels (see 'pellucid animate --help')");
  }
  refuse_arguments(arguments);
  const auto expect = [](const char* option, const std::optional<double>& value, double most) {
    if (value && !(*value > 0 && *value <= most)) {
      throw UsageError(
          fmt::format("{} {}: expected a number above 0, up to {}", option, *value, most));
    }
  };
  expect("--seconds", arguments.seconds, 86400);
  expect("--fps", arguments.fps, 1000);
  if (arguments.turns && !(std::abs(*arguments.turns) <= 1e4)) {
    throw UsageError(
        fmt::format("--turns {}: expected a number from -10000 to 10000", *arguments.turns));
  }
  const NamedFile outputs[] = {{"--output", arguments.output}};
  const NamedFile inputs[] = {
      {"INPUT", scene.input}, {"--tf", scene.transfer_function}, {"--camera", scene.camera}};
  refuse_overwriting(outputs, inputs);
}

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
  Camera camera = scene.camera;
  const std::array<Vec3<double>, 8> corners = world_corners(scene);
  const Vec3<double> forward = normalized(camera.focal_point - camera.position);
  Vec3<double> center{0, 0, 0};
  for (const Vec3<double>& corner : corners) center = center + corner * 0.125;
  camera.focal_point = center;
  camera.position = center - forward;
  const CameraFrame<double> frame = make_camera_frame(camera, scene.size);
  const double wide = length(frame.right), high = length(frame.up);
  double distance = 0;
  for (const Vec3<double>& corner : corners) {
    const Vec3<double> offset = corner - center;
    const double reach = std::max(std::abs(dot(offset, frame.right)) / (wide * wide),
                                  std::abs(dot(offset, frame.up)) / (high * high));
    distance = std::max(distance, reach - dot(offset, frame.forward));
  }
  constexpr double margin = 1.03;
  camera.position = center - forward * (distance * margin);
  return camera;
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

/// Renders the frames one after the other.
class FilmRun {
 public:
  FilmRun(const AnimateArguments& arguments, FilmShare share)
      : arguments_(arguments),
        share_(share),
        files_(arguments.output),
        parallel_(parallel_for(arguments.scene.threads > 0 ? arguments.scene.threads
                                                           : default_thread_count())) {}

  void operator()() {
    load();
    render_all();
  }

  const FilmFiles& files() const noexcept { return files_; }
  const Film& film() const { return *film_; }
  double fps() const noexcept { return animation_.fps; }
  const std::vector<int>& over() const noexcept { return over_; }

 private:
  void load() {
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

  std::string stamp_of(const SceneDescription& description) const {
    return fmt::format("pellucid {}\n{}{}{}", PELLUCID_VERSION_STRING, data_stamp(description),
                       scene_to_json(description), options_text());
  }

  /// Returns what else a picture depends on.
  std::string options_text() const {
    const RenderArguments& scene = arguments_.scene;
    return fmt::format("background {}; color bar {} '{}'", scene.background,
                       scene.wants_color_bar(), scene.color_bar_title);
  }

  /// A frame that is to be rendered, with its data.
  struct Loaded {
    int frame = 0;
    SceneDescription description;
    std::string stamp;
    Scene scene;
  };

  /// Returns the next frame from `frame` on that is not there, loaded; none: all are there.
  std::optional<Loaded> load_next(int frame) {
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

  void render_all() {
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

  template <class Show>
  void render(const Loaded& now, const Show& show) {
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
    std::optional<Background> background = shown_background(now.description);
    if (files_.is_video() && !background) background = calm_background();
    Image& image = result.image;
    if (!is_exr && arguments_.scene.wants_color_bar()) {
      std::vector<std::string> notes;
      if (auto drawn = with_wanted_color_bars(arguments_.scene, prepared_, image, notes)) {
        image = *std::move(drawn);
      }
      if (made_ == 0) notes_.insert(notes_.end(), notes.begin(), notes.end());
    }
    files_.write(now.frame, image, now.stamp, background);
  }

 public:
  /// Prints what is told of the film.
  void tell(const std::string& path) const {
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

 private:
  const AnimateArguments& arguments_;
  FilmShare share_;
  FilmFiles files_;
  ParallelFor parallel_;
  PreparedScene prepared_;
  Animation animation_;
  std::optional<Film> film_;
  std::optional<FrameLoader> loader_;
  Renderer renderer_;
  std::vector<std::string> notes_;
  std::vector<int> over_;
  int made_ = 0, kept_ = 0;
  double largest_error_ = 0;
};

std::string over_text(const std::string& frames) {
  return fmt::format(
      "some pixels of frames may be over the tolerance; the pictures' metadata say how many: {}",
      frames);
}

/// Renders a share of the frames on each rank of MPI, which see the same folder. The first makes
/// the video, and speaks for all.
int run_on_ranks(AnimateArguments arguments) {
  const std::unique_ptr<Communicator> ranks = mpi_communicator();
  const bool is_first = ranks->rank() == 0;
  if (!is_first) arguments.scene.quiet = true;
  std::optional<FilmRun> run;
  std::string failure;
  try {
    run.emplace(arguments, FilmShare{ranks->rank(), ranks->size()});
    (*run)();
  } catch (const std::exception& error) {
    failure = error.what();
  } catch (const Interrupted& interrupted) {
    failure = "interrupted";
  }
  for (const std::string& text : ranks->gather_all(failure)) {
    if (text.empty()) continue;
    if (is_first) throw Error(text);
    return 1;
  }
  const auto over = run->over().empty() ? "" : fmt::format("{}", fmt::join(run->over(), ", "));
  std::string all_over;
  for (const std::string& text : ranks->gather_all(over)) {
    if (!text.empty()) all_over += (all_over.empty() ? "" : ", ") + text;
  }
  if (is_first) {
    run->files().finish(run->film().frames(), run->fps(), arguments.keeps_frames);
    run->tell(arguments.output);
    if (!all_over.empty()) throw OverTolerance(over_text(all_over));
  }
  return 0;
}

int run_animate(AnimateArguments arguments) {
  check(arguments);
  arguments.scene.outputs = {arguments.output};  // which is held against the files of the data
  if (arguments.ranks) {
    if (!arguments.part.empty()) {
      throw UsageError("--part: --ranks deals the frames; leave one of the two out");
    }
    return run_on_ranks(arguments);
  }
  FilmRun run(arguments, parse_film_share("--part", arguments.part));
  run();
  if (arguments.part.empty()) {
    run.files().finish(run.film().frames(), run.fps(), arguments.keeps_frames);
  }
  run.tell(arguments.output);
  if (!run.over().empty()) {
    throw OverTolerance(over_text(fmt::format("{}", fmt::join(run.over(), ", "))));
  }
  return 0;
}

}  // namespace

Command add_animate(CommandLine& app) {
  CommandLine& command = *app.add_subcommand(
      "animate", "Render a film: a turntable, steps in time, or a scene's keyframes");
  const auto arguments = std::make_shared<AnimateArguments>();
  arguments->scene.suggests_functions = true;
  arguments->scene.mesh.has_times = true;
  command.add_option(
      "INPUT", arguments->scene.input,
      input_help() + ", " + mesh_input_help() + ", SCENE.json or builtin:NAME[:POINTS]");
  command
      .add_option("-o,--output", arguments->output,
                  "Write this video, .webm or .mp4 by the program ffmpeg, or pictures: a name with "
                  "a place for their number, from 0, as frames/%04d.png or .exr")
      ->option_text("FILE");
  command
      .add_option("--fps", arguments->fps,
                  "Frames per second. Default: the scene's, else 24, or 10 of steps in time")
      ->option_text("F");
  auto* seconds = command
                      .add_option("--seconds", arguments->seconds,
                                  "Length of the film. Default: the scene's, else 5, or a frame "
                                  "for each step in time")
                      ->option_text("S");
  command.add_option("--frames", arguments->frames, "Its length in frames")
      ->option_text("N")
      ->in_range(1, most_frames)
      ->excludes(seconds);
  command
      .add_option("--turns", arguments->turns,
                  "Have the camera go around so often. Default: the scene's, else 1 if the data "
                  "have no steps in time")
      ->option_text("N");
  command
      .add_option("--times", arguments->times,
                  "Times of the data at the first and the last frame. Default: the scene's, else "
                  "all of theirs")
      ->option_text("FIRST:LAST");
  command
      .add_option("--part", arguments->part,
                  "Render every N-th frame from the K-th on, K from 1, and make no video: for N "
                  "machines. A last call without it makes it")
      ->option_text("K/N");
  command.add_flag("--ranks", arguments->ranks,
                   "Deal the frames to all ranks of MPI that this program is started on, which "
                   "share the folder: mpirun -n 8 pellucid animate SCENE.json --ranks -o o.webm. "
                   "Give --threads, too");
  command.add_flag("--keep-frames", arguments->keeps_frames,
                   "Keep the pictures of a video in the folder FILE.frames");
  command.add_flag("-q,--quiet", arguments->scene.quiet, "Print no progress or notes, only errors");
  add_scene_options(command, arguments->scene);
  add_picture_options(command, arguments->scene);
  add_integration_options(command, arguments->scene);
  arguments->scene.volume.add_to(command, false);
  arguments->scene.mesh.add_to(command, true);
  command.footer(
      "Each frame is within the tolerance; a video of them is encoded with a loss of its own.\n"
      "Frames that are there and made from the same are kept: a film that was interrupted goes "
      "on.\n"
      "\n"
      "Examples:\n"
      "  pellucid animate brain.nii.gz -o brain.webm\n"
      "  pellucid animate run.pvd -o run.mp4 --fps 12 --size 800\n"
      "  pellucid animate scene.json -o frames/%04d.png --tolerance 1/4096\n"
      "  pellucid animate waves.nc --array h --times 0:6 --seconds 10 --turns 0.5 -o waves.webm");
  return {&command, [arguments] { return run_animate(*arguments); }};
}

}  // namespace pellucid::cli
