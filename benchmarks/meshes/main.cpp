// SPDX-License-Identifier: Apache-2.0

// Meshes of tetrahedra: frames and segments beside VTK's, what building them takes, and how far
// they are from the grids that they were cut from.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <thread>

#include "benchmarks/meshes/mesh_frames.h"
#include "benchmarks/meshes/mesh_report.h"
#include "benchmarks/support/document.h"
#include "benchmarks/support/environment.h"
#include "benchmarks/vtk/vtk_contenders.h"
#include "pellucid/io/internal/atomic_file.h"

namespace {

using namespace pellucid::bench;

struct Arguments {
  int size = 512;
  bool tiny = false;
  std::vector<std::string> parts{"frames", "segments", "building", "reconstruction"};
  MeshFrameOptions frames;
  std::string markdown, limitations, json, plots, commit;

  bool has(const char* part) const {
    return std::find(parts.begin(), parts.end(), part) != parts.end();
  }
};

void settle(Arguments& a) {
  if (a.tiny) {
    a.size = std::min(a.size, 24);
    a.frames.pixels = 64;
    a.frames.repeats = 1;
  }
  a.frames.size = {a.size, a.size};
  a.frames.tiny = a.tiny;
  if (a.frames.threads.empty()) {
    const int all = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    a.frames.threads = all == 1 ? std::vector<int>{1} : std::vector<int>{1, all};
  }
  a.frames.say = [](const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); };
}

/// Processes that wanted to run, the mean of the last minute: others take time from what is
/// measured.
double load_of_machine() {
  double load = 0;
  return getloadavg(&load, 1) == 1 ? load : 0;
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

std::string frames_text(const Arguments& a, const std::vector<MeshResult>& results) {
  return format("Images of %d×%d. Ours to 1/%.4g.\n", a.size, a.size, 1 / a.frames.tolerance) +
         "\n### Frames of meshes\n\nTime; in bold how many times that of *exact* on as many "
         "threads.\n\n" +
         frame_times_table(results, a.frames.threads) + "\nLargest error (root mean square):\n\n" +
         frame_errors_table(results) + "\nPer ray and tetrahedron, one thread:\n\n" +
         segment_costs_table(results);
}

std::string segments_text(const Arguments& a, const SegmentStudy& study) {
  return "\n### Segments\n\nTime of a segment of three colors on one thread, the rows of "
         "linear_segment.csv in random order.\n\n" +
         segments_table(study) +
         "\nLargest error where the ends' extinctions differ by this share, depths from 1e-6 to "
         "100:\n\n" +
         contrasts_table(study) + image(a, "Error over contrast", "segment-contrasts.svg");
}

/// Replaces the section where a file is named, else prints.
void put(const std::string& file, const char* section, const std::string& text) {
  if (file.empty()) {
    std::printf("%s", text.c_str());
  } else {
    replace_section(file, section, "\n" + text + "\n");
  }
}

void run(Arguments a) {
  settle(a);
  const double load = load_of_machine();
  const Environment where = environment(a.commit);
  nlohmann::ordered_json json{{"environment", to_json(where)}, {"load", load}};
  std::string text = to_markdown(where);
  if (const std::string vtk = vtk_version(); !vtk.empty()) text += vtk + ". ";
  text += format("Load of the machine by others before: %.1f.\n\n", load);
  if (a.has("frames")) {
    const std::vector<MeshResult> results = measure_mesh_frames(a.frames);
    text += frames_text(a, results);
    json["frames"] = to_json(results);
  }
  if (a.has("segments")) {
    a.frames.say("segments");
    const SegmentStudy study =
        a.tiny ? study_segments(1, 1e-3) : study_segments(a.frames.repeats, 0.1);
    text += segments_text(a, study);
    json["segments"] = to_json(study);
    if (!a.plots.empty()) {
      std::filesystem::create_directories(a.plots);
      pellucid::write_text_file(std::filesystem::path(a.plots) / "segment-contrasts.svg",
                                to_svg(contrasts_plot(study)));
    }
  }
  if (a.has("building")) {
    const std::vector<BuildResult> results = measure_building(
        {a.frames.threads, a.frames.repeats, a.tiny, a.frames.filters, a.frames.say});
    text += "\n### Building\n\nMillions of tetrahedra per second.\n\n" +
            building_table(results, a.frames.threads);
    json["building"] = to_json(results, a.frames.threads);
  }
  put(a.markdown, "meshes", text);
  if (a.has("reconstruction")) {
    const std::vector<ReconstructionResult> results =
        study_reconstruction({a.tiny ? 32 : 256, a.tiny, a.frames.say});
    put(a.limitations, "reconstruction", reconstruction_table(results));
    json["reconstruction"] = to_json(results);
  }
  if (!a.json.empty()) pellucid::write_text_file(a.json, json.dump(1) + "\n");
}

}  // namespace

int main(int argc, char** argv) {
  Arguments a;
  a.frames.threads.clear();
  CLI::App app("Meshes of tetrahedra: frames, segments and building, beside VTK's");
  app.add_option("--parts", a.parts, "what to measure: frames, segments, building, reconstruction")
      ->delimiter(',')
      ->check(
          CLI::IsMember(std::set<std::string>{"frames", "segments", "building", "reconstruction"}));
  app.add_option("--scenes", a.frames.filters, "parts of \"MESH, SCENE\"; default: all");
  app.add_option("--size", a.size, "width and height of the images")
      ->capture_default_str()
      ->check(CLI::Range(4, 4096));
  app.add_option("--pixels", a.frames.pixels, "of each image, to hold against the reference")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--repeats", a.frames.repeats, "rounds of which the median is taken")
      ->capture_default_str()
      ->check(CLI::Range(1, 100));
  app.add_option("--tolerance", a.frames.tolerance, "of ours; default: 1/512")
      ->check(CLI::Range(1e-12, 0.5));
  app.add_option("--longest-repeated", a.frames.longest_repeated_seconds,
                 "seconds; frames that take longer are rendered once")
      ->capture_default_str();
  app.add_option("--threads", a.frames.threads, "numbers of threads; default: 1 and all")
      ->delimiter(',')
      ->check(CLI::PositiveNumber);
  app.add_flag("!--no-vtk", a.frames.vtk, "without VTK's mappers");
  app.add_flag("!--no-sweep", a.frames.sweep, "without VTK's ZSweep mapper");
  app.add_flag("--sweep-axis", a.frames.sweep_axis,
               "VTK's ZSweep mapper along axes too, where it takes minutes");
  app.add_flag("--tiny", a.tiny, "small meshes: to try this program");
  app.add_option("--cache", a.frames.cache, "folder that keeps reference pixels");
  app.add_option("--markdown", a.markdown, "file to put the tables into; default: print")
      ->check(CLI::ExistingFile);
  app.add_option("--limitations", a.limitations,
                 "file to put the table of reconstructions into; default: print")
      ->check(CLI::ExistingFile);
  app.add_option("--json", a.json, "file for all figures");
  app.add_option("--plots", a.plots, "folder for plots, as SVG");
  app.add_option("--commit", a.commit, "commit to name in the tables");
  CLI11_PARSE(app, argc, argv);
  try {
    run(std::move(a));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_meshes: %s\n", error.what());
    return 1;
  }
  return 0;
}
