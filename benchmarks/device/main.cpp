// SPDX-License-Identifier: Apache-2.0

// Frames per second on a card, beside the midpoint sampler on the same card at the step with the
// same largest error, and beside the CPU. Without a card it says so and ends.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "benchmarks/device/speed.h"
#include "benchmarks/support/environment.h"
#include "pellucid/cuda/device_backend.h"
#include "pellucid/scene/error.h"

namespace {

using namespace pellucid;

struct Arguments {
  int size = 1024, points = 512;
  std::string device = "cuda", commit;
  std::vector<std::string> scenes;
  bench::SpeedOptions speed;
  bool tiny = false;
};

void run(const Arguments& arguments) {
  std::printf("%s", bench::to_markdown(bench::environment(arguments.commit)).c_str());
  // The scan is read from a file.
  const std::vector<std::string> parts =
      arguments.tiny ? std::vector<std::string>{"oblique"} : arguments.scenes;
  std::vector<std::string> missing;
  std::vector<bench::Speed> rows;
  for (const scenes::NamedScene& named :
       bench::speed_scenes(arguments.points, {arguments.size, arguments.size}, parts, missing)) {
    std::fprintf(stderr, "%s\n", named.name.c_str());
    rows.push_back(bench::measure_speed(named, arguments.speed));
  }
  for (const std::string& name : missing) {
    std::printf("Left out, for want of data: %s.\n", name.c_str());
  }
  std::printf(
      "\nData %d³, image %d x %d, tolerance 1/512, %d frames of a camera that turns; errors: the "
      "largest over %zu pixels of the first frame.\n\n%s",
      arguments.points, arguments.size, arguments.size, arguments.speed.frames,
      arguments.speed.pixels, bench::speed_markdown(rows).c_str());
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Frames per second on a card");
  Arguments arguments;
  app.add_option("--size", arguments.size, "Pixels along an edge of the image");
  app.add_option("--points", arguments.points, "Values along an edge of the data");
  app.add_option("--scenes", arguments.scenes, "Only those whose name contains one of these");
  app.add_option("--frames", arguments.speed.frames, "Frames of a measurement");
  app.add_option("--threads", arguments.speed.threads, "Of the CPU; 0: one per core");
  app.add_option("--pixels", arguments.speed.pixels, "Pixels that the reference is asked for");
  app.add_option("--device", arguments.device, "cuda, or emulated to try the program");
  app.add_option("--commit", arguments.commit);
  app.add_option("--cache", arguments.speed.cache, "Folder of reference pixels");
  app.add_flag("--tiny", arguments.tiny, "Small data and images, to try the program");
  app.add_flag("!--no-cpu", arguments.speed.cpu, "Leave the CPU out");
  CLI11_PARSE(app, argc, argv);
  if (arguments.tiny) {
    arguments.size = arguments.points = 32;
    arguments.speed.frames = 2;
    arguments.speed.pixels = 128;
  }
  try {
    arguments.speed.device = arguments.device == "emulated" ? Device::emulated : Device::cuda;
    if (arguments.speed.device == Device::cuda) {
      try {
        std::printf("Card: %s\n\n", make_cuda_backend()->name().c_str());
      } catch (const Error& error) {
        std::printf("SKIPPED: %s\n", error.what());
        return 0;
      }
    }
    run(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_device: %s\n", error.what());
    return 1;
  }
  return 0;
}
