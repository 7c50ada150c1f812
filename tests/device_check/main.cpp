// SPDX-License-Identifier: Apache-2.0

// The parts of scripts/device-check, one in a call. Ends with 0 where all is good, 1 where
// something is not as it says, and 2 where the part could not do its work.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <map>
#include <string>

#include "benchmarks/support/environment.h"
#include "pellucid/cuda/device_backend.h"
#include "tests/device_check/parts.h"
#include "tests/device_check/rows.h"

namespace pellucid::device_check {

bool name_device(const Arguments& arguments) {
  const std::string name = arguments.device == Device::cuda ? make_cuda_backend()->name()
                                                            : make_emulated_backend()->name();
  RowWriter(arguments.rows).add({{"kind", "device"}, {"name", name}});
  std::printf("%s\n", name.c_str());
  return true;
}

}  // namespace pellucid::device_check

int main(int argc, char** argv) {
  using namespace pellucid;
  using namespace pellucid::device_check;
  CLI::App app("What scripts/device-check asks of a card, part by part");
  app.require_subcommand(1);
  Arguments arguments;
  const auto part = [&](const char* name, const char* about) {
    CLI::App* const command = app.add_subcommand(name, about);
    command->add_option("--device", arguments.device, "cuda, or emulated: a card's functions")
        ->transform(CLI::CheckedTransformer(
            std::map<std::string, Device>{{"cuda", Device::cuda}, {"emulated", Device::emulated}}));
    command->add_option("--threads", arguments.threads, "of the CPU; 0: one per core");
    command->add_option("--rows", arguments.rows, "file that results are appended to");
    command->add_option("--truths", arguments.truths, "folder of what the reference sees");
    command->add_option("--size", arguments.size, "pixels along an edge of the frames")
        ->check(CLI::Range(4, 4096));
    return command;
  };
  const auto with_matrix = [&](CLI::App* command) {
    command->add_option("--every", arguments.every, "takes every N-th scene")
        ->check(CLI::Range(1, 1000));
    command->add_option("--cameras", arguments.cameras, "of each scene")->check(CLI::Range(1, 3));
    return command;
  };
  const auto with_data = [&](CLI::App* command) {
    command->add_option("--points", arguments.points, "data values along an edge")
        ->check(CLI::Range(2, 2048));
    return command;
  };
  CLI::App* const device = part("device", "Name the device");
  CLI::App* const truths = with_matrix(part("truths", "Make the truth for another machine"));
  CLI::App* const matrix = with_matrix(part("matrix", "Hold scenes against the truth"));
  CLI::App* const frames = with_data(part("frames", "Compare the bits of frames"));
  frames->add_option("--against", arguments.against, "results of the first run");
  frames->add_flag("--examples", arguments.examples, "a small scene for each kernel, and no more");
  CLI::App* const speed = with_data(part("speed", "Measure frames per second"));
  speed->add_option("--scenes", arguments.scenes, "those whose name contains one of these");
  speed->add_option("--frames", arguments.speed.frames, "of a measurement")
      ->check(CLI::Range(2, 10000));
  speed->add_option("--seconds", arguments.speed.seconds, "of a measurement, at most");
  speed->add_option("--pixels", arguments.speed.pixels, "that the reference is asked for");
  std::string folder, json, markdown, commit;
  CLI::App* const tables = app.add_subcommand("tables", "Make the table of all parts");
  tables->add_option("folder", folder)->required();
  tables->add_option("--json", json)->required();
  tables->add_option("--markdown", markdown)->required();
  tables->add_option("--commit", commit);
  CLI11_PARSE(app, argc, argv);
  try {
    bool good = true;
    if (*device) good = name_device(arguments);
    if (*truths) good = make_truths(arguments);
    if (*matrix) good = check_matrix(arguments);
    if (*frames) good = check_frames(arguments);
    if (*speed) good = check_speed(arguments);
    if (*tables) write_tables(folder, json, markdown, commit);
    return good ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "device_check: %s\n", error.what());
    return 2;
  }
}
