// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>

namespace pellucid::bench {

/// What a program that times frames takes.
struct FrameArguments {
  int size = 512, points = 256, threads = 2, rounds = 5;
  bool tiny = false;
};

/// The main() of such a program: parses its arguments and calls run(arguments). `--tiny` makes size
/// and points at most this. Returns the exit status.
template <class Run>
int time_frames(int argc, char** argv, const std::string& name, const std::string& about,
                int tiny_size, int tiny_points, const Run& run) {
  FrameArguments arguments;
  CLI::App app(about);
  app.add_option("--size", arguments.size, "width and height of the images")
      ->capture_default_str()
      ->check(CLI::Range(4, 4096));
  app.add_option("--points", arguments.points, "data values per axis of the made volume")
      ->capture_default_str()
      ->check(CLI::Range(16, 1024));
  app.add_option("--threads", arguments.threads, "threads")->capture_default_str();
  app.add_option("--repeats", arguments.rounds, "rounds; the median of them is printed")
      ->capture_default_str()
      ->check(CLI::Range(1, 100));
  app.add_flag("--tiny", arguments.tiny, "small data: to try this program");
  CLI11_PARSE(app, argc, argv);
  if (arguments.tiny) {
    arguments.size = std::min(arguments.size, tiny_size);
    arguments.points = tiny_points;
    arguments.rounds = 1;
  }
  try {
    run(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", name.c_str(), error.what());
    return 1;
  }
  return 0;
}

}  // namespace pellucid::bench
