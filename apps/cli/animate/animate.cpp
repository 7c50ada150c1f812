// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "arguments/output.h"
#include "arguments/overwriting.h"
#include "arguments/parse.h"
#include "commands.h"
#include "film_run.h"
#include "pellucid/cluster/communicator.h"
#include "render/progress.h"
#include "render/tolerance.h"

namespace pellucid::cli {

namespace {

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

/// Tells of frames with pixels over the tolerance, by their numbers.
std::string over_text(std::vector<int> frames) {
  std::ranges::sort(frames);
  if (frames.size() == 1) {
    return fmt::format(
        "some pixels of frame {} may be over the tolerance; its metadata say how many",
        frames.front());
  }
  const int last = frames.back();
  frames.pop_back();
  return fmt::format(
      "some pixels of frames {} and {} may be over the tolerance; their metadata say how many",
      fmt::join(frames, ", "), last);
}

/// Makes the file of a film whose frames are there. A signal ends it, and leaves no part of it.
void finish(const FilmRun& run, const AnimateArguments& arguments) {
  const InterruptGuard guard;
  const bool is_made = run.files().finish(run.film().frames(), run.fps(), arguments.keeps_frames,
                                          [] { return InterruptGuard::interrupted(); });
  if (!is_made) InterruptGuard::check();
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
    if (is_first) print_error(text);
    // mpirun ends all when one fails: not before this one has spoken.
    static_cast<void>(ranks->gather_all(""));
    return 1;
  }
  std::vector<int> all_over;
  for (const std::string& text :
       ranks->gather_all(fmt::format("{}", fmt::join(run->over(), " ")))) {
    std::istringstream numbers(text);
    for (int frame = 0; numbers >> frame;) all_over.push_back(frame);
  }
  if (is_first) {
    finish(*run, arguments);
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
  if (arguments.part.empty()) finish(run, arguments);
  run.tell(arguments.output);
  if (!run.over().empty()) throw OverTolerance(over_text(run.over()));
  return 0;
}

}  // namespace

Command add_animate(CommandLine& app) {
  CommandLine& command = *app.add_subcommand(
      "animate", "Render a film: a turntable, steps in time, or a scene's keyframes");
  const auto arguments = std::make_shared<AnimateArguments>();
  arguments->scene.suggests_functions = true;
  arguments->scene.mesh.has_times = true;
  command.add_option("INPUT", arguments->scene.input, scene_input_help());
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
