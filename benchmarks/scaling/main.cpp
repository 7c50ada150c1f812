// SPDX-License-Identifier: Apache-2.0

// How the time of a frame goes with threads, instruction sets, the data's size and empty space.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <thread>

#include "benchmarks/scaling/study.h"
#include "benchmarks/support/document.h"
#include "benchmarks/support/environment.h"
#include "pellucid/io/internal/atomic_file.h"

namespace {

struct Arguments {
  pellucid::bench::StudyOptions study;
  bool tiny = false;
  std::string markdown, json, commit;
};

void run(Arguments arguments) {
  using namespace pellucid::bench;
  StudyOptions& options = arguments.study;
  if (arguments.tiny) {
    options.size = std::min(options.size, 32);
    options.points = 32;
    options.largest_points = 64;
    options.rounds = 2;
  }
  options.threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  options.say = [](const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); };
  const Study studies[] = {study_threads(options), study_instruction_sets(options),
                           study_size(options), study_empty_space(options)};
  const char* const titles[] = {
      "Threads\n\nTime, and how many times faster than on one.\n",
      "Instruction sets\n\nOne thread; time, and how many times faster than scalar.\n",
      "Size of the data\n\nAll threads. A cell is crossed where a ray passes through it, and "
      "visited where the method looks at it.\n",
      "Empty space\n\nAll threads. A ball in the middle of the box and nothing around it.\n"};
  const Environment where = environment(arguments.commit);
  std::string text = to_markdown(where) + format("\nImages of %d×%d, data of %d³ unless said.\n",
                                                 options.size, options.size, options.points);
  nlohmann::ordered_json json{{"environment", to_json(where)}, {"image", options.size}};
  for (std::size_t i = 0; i < std::size(studies); ++i) {
    text += std::string("\n### ") + titles[i] + "\n" + studies[i].markdown;
    json[studies[i].name] = studies[i].figures;
  }
  if (arguments.markdown.empty()) {
    std::printf("%s", text.c_str());
  } else {
    replace_section(arguments.markdown, "scaling", "\n" + text + "\n");
  }
  if (!arguments.json.empty()) pellucid::write_text_file(arguments.json, json.dump(1) + "\n");
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("How the time of a frame goes with threads, instruction sets, size and emptiness");
  app.add_option("--size", arguments.study.size, "width and height of the images")
      ->capture_default_str()
      ->check(CLI::Range(4, 4096));
  app.add_option("--repeats", arguments.study.rounds, "rounds of which the median is taken")
      ->capture_default_str()
      ->check(CLI::Range(1, 100));
  app.add_option("--points", arguments.study.points, "data values per axis")
      ->capture_default_str()
      ->check(CLI::Range(16, 1024));
  app.add_option("--largest", arguments.study.largest_points, "data values per axis, at most")
      ->capture_default_str()
      ->check(CLI::Range(16, 2048));
  app.add_flag("--tiny", arguments.tiny, "small data: to try this program");
  app.add_option("--markdown", arguments.markdown, "file to put the tables into; default: print")
      ->check(CLI::ExistingFile);
  app.add_option("--json", arguments.json, "file for all figures");
  app.add_option("--commit", arguments.commit, "commit to name in the tables");
  CLI11_PARSE(app, argc, argv);
  try {
    run(std::move(arguments));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_scaling: %s\n", error.what());
    return 1;
  }
  return 0;
}
