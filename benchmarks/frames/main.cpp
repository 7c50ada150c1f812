// SPDX-License-Identifier: Apache-2.0

// Time and error of whole frames, by every method that is there, on the scenes of tests/scenes.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <thread>

#include "benchmarks/frames/measure.h"
#include "benchmarks/frames/report.h"
#include "benchmarks/frames/scene_list.h"
#include "benchmarks/support/document.h"
#include "benchmarks/support/environment.h"
#include "benchmarks/vtk/vtk_contenders.h"
#include "pellucid/io/internal/atomic_file.h"

namespace {

struct Arguments {
  int size = 512;
  bool no_vtk = false;
  pellucid::bench::SceneSelection selection;
  pellucid::bench::MeasureOptions measure;
  std::string markdown, section = "frames", json, plots, commit;
};

void settle(Arguments& arguments) {
  using namespace pellucid::bench;
  if (arguments.selection.tiny) {
    arguments.size = std::min(arguments.size, 48);
    arguments.measure.pellucid.tolerances = {1e-1, 1e-2, 1.0 / 512, 1e-4};
    arguments.measure.pellucid.proved_tolerances = {1e-2, 1.0 / 512};
    arguments.measure.pellucid.steps = {2, 1, 0.5, 0.1};
    arguments.measure.vtk_steps = {1, 0.5};
    arguments.measure.repeats = 2;
    arguments.measure.pixels = 256;
  }
  arguments.selection.size = {arguments.size, arguments.size};
  arguments.measure.vtk = !arguments.no_vtk;
  int& threads = arguments.measure.pellucid.threads;
  if (threads == 0) threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  arguments.measure.say = [](const std::string& line) {
    std::fprintf(stderr, "%s\n", line.c_str());
  };
}

/// As a reader of the Markdown file refers to it.
std::string plot_folder(const Arguments& arguments) {
  if (arguments.plots.empty() || arguments.markdown.empty()) return arguments.plots;
  const auto from = std::filesystem::absolute(arguments.markdown).parent_path();
  return std::filesystem::absolute(arguments.plots).lexically_relative(from).string();
}

void run(Arguments arguments) {
  using namespace pellucid::bench;
  settle(arguments);
  const int threads = arguments.measure.pellucid.threads;
  std::vector<SceneResult> results;
  const std::vector<std::string> missing = for_each_scene(
      arguments.selection,
      [&](const NamedScene& named) { results.push_back(measure(named, arguments.measure)); });
  if (results.empty()) throw std::runtime_error("no scene has a name like that");

  const Environment where = environment(arguments.commit);
  std::string text = to_markdown(where);
  if (arguments.measure.vtk && !vtk_version().empty()) text += vtk_version() + ".\n";
  text += "\n";
  for (const std::string& name : missing) text += "The data of " + name + " were not there.\n\n";
  text += frames_markdown(results, threads, plot_folder(arguments));
  if (arguments.markdown.empty()) {
    std::printf("%s", text.c_str());
  } else {
    replace_section(arguments.markdown, arguments.section, "\n" + text + "\n");
  }
  if (!arguments.json.empty()) {
    const nlohmann::ordered_json json{{"environment", to_json(where)},
                                      {"vtk", vtk_version()},
                                      {"threads", threads},
                                      {"scenes", frames_json(results)}};
    pellucid::write_text_file(arguments.json, json.dump(1) + "\n");
  }
  if (arguments.plots.empty()) return;
  std::filesystem::create_directories(arguments.plots);
  for (const SceneResult& result : results) {
    pellucid::write_text_file(std::filesystem::path(arguments.plots) / plot_file(result, threads),
                              to_svg(time_error_plot(result, threads)));
  }
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  auto& measure = arguments.measure;
  CLI::App app("Time and error of whole frames against the reference");
  app.add_option("--size", arguments.size, "width and height of the images")
      ->capture_default_str()
      ->check(CLI::Range(4, 4096));
  app.add_option("--pixels", measure.pixels, "of each image, to hold against the reference")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--repeats", measure.repeats, "rounds of which the median is taken, at most")
      ->capture_default_str()
      ->check(CLI::Range(1, 100));
  app.add_option("--scene-seconds", measure.scene_seconds,
                 "seconds after which a scene gets no further round")
      ->capture_default_str();
  app.add_option("--threads", measure.pellucid.threads, "0: one per core")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--scenes", arguments.selection.filters,
                 "only those whose name contains one of these");
  app.add_flag("--all-views", arguments.selection.all_views, "every view and every torture scene");
  app.add_option("--methods", measure.pellucid.methods, "sampling methods, by name")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--steps", measure.pellucid.steps, "of the sampling methods, in voxels")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--tolerances", measure.pellucid.tolerances, "of exact, estimated")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--proved-tolerances", measure.pellucid.proved_tolerances, "of exact, proved")
      ->delimiter(',')
      ->capture_default_str();
  app.add_flag("--no-vtk", arguments.no_vtk, "leave VTK out");
  app.add_option("--vtk-steps", measure.vtk_steps, "of VTK's mappers, in voxels")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--longest", measure.longest_seconds,
                 "seconds at which a curve ends, but one of a sampler not known to be slower")
      ->capture_default_str();
  app.add_option("--longest-repeated", measure.longest_repeated_seconds,
                 "seconds above which a frame is not repeated")
      ->capture_default_str();
  app.add_flag("--tiny", arguments.selection.tiny, "small data and few steps: to try this program");
  app.add_option("--cache", measure.cache, "folder that keeps reference pixels");
  app.add_option("--markdown", arguments.markdown, "file to put the tables into; default: print")
      ->check(CLI::ExistingFile);
  app.add_option("--section", arguments.section, "section of that file")->capture_default_str();
  app.add_option("--json", arguments.json, "file for all figures");
  app.add_option("--plots", arguments.plots, "folder for a plot of each scene, as SVG");
  app.add_option("--commit", arguments.commit, "commit to name in the tables");
  CLI11_PARSE(app, argc, argv);
  try {
    run(std::move(arguments));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_frames: %s\n", error.what());
    return 1;
  }
  return 0;
}
