// SPDX-License-Identifier: Apache-2.0

// Time and error of whole frames against the reference, on the scenes of tests/scenes.

#include <CLI/CLI.hpp>
#include <cstdio>

#include "benchmarks/frames/report.h"
#include "benchmarks/frames/scene_list.h"
#include "benchmarks/support/document.h"
#include "benchmarks/support/environment.h"
#include "pellucid/io/atomic_file.h"

namespace {

struct Arguments {
  int size = 144;
  pellucid::bench::SceneSelection selection;
  pellucid::bench::MeasureOptions measure;
  std::string markdown, section = "frames", json, commit;
};

void run(Arguments arguments) {
  using namespace pellucid::bench;
  arguments.selection.size = {arguments.size, arguments.size};
  if (arguments.selection.tiny) arguments.measure.steps = {2, 1, 0.5};
  arguments.measure.say = [](const std::string& line) {
    std::fprintf(stderr, "%s\n", line.c_str());
  };
  std::vector<SceneResult> results;
  const std::vector<std::string> missing = for_each_scene(
      arguments.selection,
      [&](const NamedScene& named) { results.push_back(measure(named, arguments.measure)); });

  const Environment where = environment(arguments.commit);
  std::string text = to_markdown(where) + "\n";
  for (const std::string& name : missing) text += "The data of " + name + " were not there.\n\n";
  text += frames_markdown(results);
  if (arguments.markdown.empty()) {
    std::printf("%s", text.c_str());
  } else {
    replace_section(arguments.markdown, arguments.section, "\n" + text + "\n");
  }
  if (!arguments.json.empty()) {
    nlohmann::ordered_json json{{"environment", to_json(where)}, {"scenes", frames_json(results)}};
    pellucid::write_text_file(arguments.json, json.dump(1) + "\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Time and error of whole frames against the reference");
  app.add_option("--size", arguments.size, "width and height of the images")
      ->capture_default_str()
      ->check(CLI::Range(4, 4096));
  app.add_option("--repeats", arguments.measure.repeats, "runs of which the median is taken")
      ->capture_default_str()
      ->check(CLI::Range(1, 100));
  app.add_option("--threads", arguments.measure.threads, "0: one per core")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--scenes", arguments.selection.filter, "only those whose name contains this");
  app.add_flag("--all-views", arguments.selection.all_views, "every view and every torture scene");
  app.add_flag("--exact-only", arguments.measure.exact_only, "no sampling rules");
  app.add_flag("--tiny", arguments.selection.tiny, "small data and few steps: to try this program");
  app.add_option("--cache", arguments.measure.cache, "folder that keeps reference images");
  app.add_option("--markdown", arguments.markdown, "file to put the tables into; default: print");
  app.add_option("--section", arguments.section, "section of that file")->capture_default_str();
  app.add_option("--json", arguments.json, "file for all figures");
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
