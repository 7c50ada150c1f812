// SPDX-License-Identifier: Apache-2.0

// Frames of Gaussian primitives over one channel and several: exact beside sampling, over the
// primitives' width and over the numbers of primitives and channels.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <thread>

#include "benchmarks/frames/measure.h"
#include "benchmarks/gaussians/gaussian_report.h"
#include "benchmarks/gaussians/gaussian_scenes.h"
#include "benchmarks/support/document.h"
#include "benchmarks/support/environment.h"
#include "pellucid/io/internal/atomic_file.h"

namespace {

using namespace pellucid::bench;

struct Arguments {
  int size = 256, points = 128;
  bool tiny = false, widths_alone = false;
  std::vector<double> widths{0.2, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001, 0.0005};
  std::vector<int> primitives{1, 2, 4, 8, 16, 32, 64}, channels{1, 2, 3, 4, 6, 8};
  MeasureOptions measure;
  std::string markdown, json, plots, commit;
};

void settle(Arguments& a) {
  if (a.tiny) {
    a.size = std::min(a.size, 24);
    a.points = std::min(a.points, 24);
    a.widths = {0.2, 0.02};
    a.primitives = {1, 4};
    a.channels = {1, 3};
    a.measure.pellucid.steps = {1, 0.5, 0.1};
    a.measure.repeats = 1;
    a.measure.pixels = 64;
  }
  int& threads = a.measure.pellucid.threads;
  if (threads == 0) threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  a.measure.vtk = false;
  a.measure.say = [](const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); };
}

SceneResult result_of(const GaussianScene& scene, int size, const MeasureOptions& options) {
  return measure({scene.name, scene.make({size, size})}, options);
}

/// Of what is read off at one error: the settings around it.
MeasureOptions for_counts(MeasureOptions options) {
  options.pellucid.tolerances = {1e-2, 1.0 / 512};
  options.pixels = std::min<std::size_t>(options.pixels, 768);
  options.scene_seconds = std::min(options.scene_seconds, 10.0);
  return options;
}

struct Results {
  Series widths{"width", {}};
  std::vector<SceneResult> scans;
  std::vector<Series> primitives{{"apart", {}}, {"one on top of the other", {}}};
  std::vector<Series> channels{{"", {}}};
};

Results measure_all(const Arguments& a) {
  Results r;
  for (const double width : a.widths) {
    r.widths.points.push_back({width, result_of(width_scene(a.points, width), a.size, a.measure)});
  }
  if (a.widths_alone) return r;
  if (!a.tiny) {
    for (const GaussianScene& scan : scan_scenes()) {
      r.scans.push_back(result_of(scan, a.size, a.measure));
    }
  }
  const MeasureOptions few = for_counts(a.measure);
  for (const int count : a.primitives) {
    for (const bool apart : {true, false}) {
      r.primitives[apart ? 0 : 1].points.push_back(
          {static_cast<double>(count),
           result_of(primitives_scene(a.points, count, apart), a.size, few)});
    }
  }
  for (const int count : a.channels) {
    r.channels[0].points.push_back(
        {static_cast<double>(count), result_of(channels_scene(a.points, count), a.size, few)});
  }
  return r;
}

std::vector<SceneResult> results_of(const Series& series) {
  std::vector<SceneResult> list;
  for (const SeriesPoint& point : series.points) list.push_back(point.result);
  return list;
}

/// As a reader of the Markdown file refers to it.
std::string image(const Arguments& a, const std::string& what, const std::string& file) {
  if (a.plots.empty()) return {};
  std::filesystem::path folder = a.plots;
  if (!a.markdown.empty()) {
    const auto from = std::filesystem::absolute(a.markdown).parent_path();
    folder = std::filesystem::absolute(folder).lexically_relative(from);
  }
  return "\n![" + what + "](" + (folder / file).string() + ")\n";
}

std::string markdown(const Arguments& a, const Results& r) {
  const int threads = a.measure.pellucid.threads;
  std::vector<SceneResult> scenes = results_of(r.widths);
  scenes.insert(scenes.end(), r.scans.begin(), r.scans.end());
  std::string text =
      format("Frames on %d thread%s. Images of %d×%d; computed fields of %d³ points.\n", threads,
             threads == 1 ? "" : "s", a.size, a.size, a.points);
  if (!a.tiny && !a.widths_alone) {
    for (const std::string& name : missing_scan_scenes()) {
      text += "The data of " + name + " were not there.\n";
    }
  }
  text += "\n### Gaussians at an equal largest error\n\n" + equal_error_table(scenes);
  text +=
      "\nWhere sampling catches up, by the primitives' width (to 1/e, of the data's range):\n\n" +
      crossings(r.widths) + image(a, "Time over width", "gaussian-widths.svg");
  if (a.widths_alone) return text;
  text += "\n### Numbers of primitives\n\nTime to 1/512.\n\n" +
          counts_table("primitives", r.primitives, pellucid::default_tolerance) +
          image(a, "Time over primitives", "gaussian-primitives.svg");
  text += "\n### Numbers of channels\n\nTime to 1/512.\n\n" +
          counts_table("channels", r.channels, pellucid::default_tolerance) +
          image(a, "Time over channels", "gaussian-channels.svg");
  return text;
}

nlohmann::ordered_json to_json(const Results& r) {
  std::vector<SceneResult> all = results_of(r.widths);
  const auto append = [&](const std::vector<SceneResult>& list) {
    all.insert(all.end(), list.begin(), list.end());
  };
  append(r.scans);
  for (const Series& series : r.primitives) append(results_of(series));
  for (const Series& series : r.channels) append(results_of(series));
  return frames_json(all);
}

void write_plots(const std::filesystem::path& folder, const Results& r) {
  std::filesystem::create_directories(folder);
  const auto write = [&](const char* file, const Plot& plot) {
    pellucid::write_text_file(folder / file, to_svg(plot));
  };
  constexpr double error = pellucid::default_tolerance;
  write("gaussian-widths.svg", ratio_plot(r.widths));
  if (r.channels.front().points.empty()) return;
  write("gaussian-primitives.svg", counts_plot("primitives", r.primitives, error));
  write("gaussian-channels.svg", counts_plot("channels", r.channels, error));
}

void run(Arguments a) {
  settle(a);
  const Results results = measure_all(a);
  const Environment where = environment(a.commit);
  const std::string text = to_markdown(where) + "\n" + markdown(a, results);
  if (a.markdown.empty()) {
    std::printf("%s", text.c_str());
  } else {
    replace_section(a.markdown, "gaussians", "\n" + text + "\n");
  }
  if (!a.json.empty()) {
    const nlohmann::ordered_json json{{"environment", pellucid::bench::to_json(where)},
                                      {"threads", a.measure.pellucid.threads},
                                      {"scenes", ::to_json(results)}};
    pellucid::write_text_file(a.json, json.dump(1) + "\n");
  }
  if (!a.plots.empty()) write_plots(a.plots, results);
}

}  // namespace

int main(int argc, char** argv) {
  Arguments a;
  PellucidSettings& pellucid = a.measure.pellucid;
  pellucid.tolerances = {1e-2, 1.0 / 512, 1e-4};
  pellucid.proved_tolerances = {};
  pellucid.methods = {"midpoint"};
  pellucid.steps = {2, 1, 0.5, 0.25, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002};
  a.measure.scene_seconds = 20;
  a.measure.longest_seconds = 3;
  a.measure.repeats = 3;
  CLI::App app("Time and error of frames of Gaussian primitives, exact beside sampling");
  app.add_option("--size", a.size, "width and height of the images")
      ->capture_default_str()
      ->check(CLI::Range(4, 4096));
  app.add_option("--points", a.points, "data values per axis of computed fields")
      ->capture_default_str()
      ->check(CLI::Range(8, 1024));
  app.add_option("--widths", a.widths, "of primitives, of the data's range, the widest first")
      ->delimiter(',')
      ->capture_default_str();
  app.add_flag("--widths-alone", a.widths_alone, "no scans, no numbers of primitives and channels");
  app.add_option("--pixels", a.measure.pixels, "of each image, to hold against the reference")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--repeats", a.measure.repeats, "rounds of which the median is taken, at most")
      ->capture_default_str()
      ->check(CLI::Range(1, 100));
  app.add_option("--scene-seconds", a.measure.scene_seconds,
                 "seconds after which a scene gets no further round")
      ->capture_default_str();
  app.add_option("--threads", pellucid.threads, "0: one per core")->check(CLI::NonNegativeNumber);
  app.add_option("--methods", pellucid.methods, "sampling methods, by name")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--steps", pellucid.steps, "of the sampling methods, in voxels")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--tolerances", pellucid.tolerances, "of exact")
      ->delimiter(',')
      ->capture_default_str();
  app.add_flag("--tiny", a.tiny, "small data and few steps: to try this program");
  app.add_option("--cache", a.measure.cache, "folder that keeps reference pixels");
  app.add_option("--markdown", a.markdown, "file to put the tables into; default: print")
      ->check(CLI::ExistingFile);
  app.add_option("--json", a.json, "file for all figures");
  app.add_option("--plots", a.plots, "folder for plots, as SVG");
  app.add_option("--commit", a.commit, "commit to name in the tables");
  CLI11_PARSE(app, argc, argv);
  try {
    run(std::move(a));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_gaussians: %s\n", error.what());
    return 1;
  }
  return 0;
}
