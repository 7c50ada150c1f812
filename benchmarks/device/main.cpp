// SPDX-License-Identifier: Apache-2.0

// Frames per second on a card, beside the midpoint sampler on the same card at the step with the
// same largest error, and beside the CPU. Without a card it says so and ends.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/device/turning.h"
#include "benchmarks/frames/reference_pixels.h"
#include "benchmarks/support/environment.h"
#include "pellucid/cuda/device_backend.h"
#include "pellucid/scene/error.h"
#include "tests/scenes/peers.h"
#include "tests/scenes/real.h"

namespace {

using namespace pellucid;
using bench::Turning;

struct Arguments {
  int size = 1024, points = 512, frames = 30, threads = 0;
  std::size_t pixels = 2048;
  std::string device = "cuda", commit, cache;
  bool cpu = true, tiny = false;
};

struct Row {
  std::string name;
  double exact = 0, exact_error = 0;                ///< frames per second; largest error
  double sampler = 0, sampler_error = 0, step = 0;  ///< at that step, voxels
  double cpu = 0;
  double in_double = 0;  ///< share of the pixels
  std::string device;
};

/// The coarsest step of halves whose largest error is not above the exact one's, and its speed.
void measure_sampler(Scene scene, const Arguments& arguments, Device device,
                     const bench::ReferencePixels& reference, Row& row) {
  scene.integration = {};
  scene.integration.method = Method::midpoint;
  scene.integration.precision = Precision::float32;
  for (double step = 2; step >= 1.0 / 256; step /= 2) {
    scene.integration.step = step;
    Turning turning(scene, device, arguments.threads);
    const double error = error_of(turning.first().image, reference).largest;
    if (error > row.exact_error && step > 1.0 / 256) continue;
    row.step = step;
    row.sampler_error = error;
    row.sampler = turning.frames_per_second(arguments.frames);
    return;
  }
}

Row measure(const std::string& name, const Scene& scene, const Arguments& arguments,
            Device device) {
  Row row;
  row.name = name;
  const bench::ReferencePixels reference = bench::reference_pixels(
      scene, arguments.pixels, std::max(arguments.threads, 2), arguments.cache);
  Turning turning(scene, device, arguments.threads);
  const bench::FirstFrame& first = turning.first();
  row.device = first.report.device;
  row.exact_error = error_of(first.image, reference).largest;
  row.in_double =
      static_cast<double>(first.report.pixels_in_double) / static_cast<double>(first.report.pixels);
  row.exact = turning.frames_per_second(arguments.frames);
  if (!scene.layers[0].shading) measure_sampler(scene, arguments, device, reference, row);
  if (arguments.cpu) {
    row.cpu = Turning(scene, Device::cpu, arguments.threads)
                  .frames_per_second(std::max(arguments.frames / 10, 2));
  }
  return row;
}

void print(const std::vector<Row>& rows, const Arguments& arguments) {
  std::printf(
      "\nImage %d x %d, tolerance 1/512, %d frames of a camera that turns; errors: the "
      "largest over %zu pixels of the first frame.\n\n",
      arguments.size, arguments.size, arguments.frames, arguments.pixels);
  std::printf(
      "| scene | exact: frames/s | error | again in double | sampler: frames/s | step | "
      "error | exact / sampler | CPU: frames/s |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const Row& row : rows) {
    std::printf("| %s | %.4g | %.1e | %.1f %% | ", row.name.c_str(), row.exact, row.exact_error,
                100 * row.in_double);
    if (row.sampler > 0) {
      std::printf("%.4g | %g | %.1e | %.3g | ", row.sampler, row.step, row.sampler_error,
                  row.exact / row.sampler);
    } else {
      std::printf("– | – | – | – | ");
    }
    std::printf("%.4g |\n", row.cpu);
  }
  for (const Row& row : rows) std::printf("\n- %s: %s", row.name.c_str(), row.device.c_str());
  std::printf("\n");
}

std::vector<scenes::NamedScene> scenes_of(const Arguments& arguments) {
  const ImageSize size{arguments.size, arguments.size};
  std::vector<scenes::NamedScene> result;
  for (scenes::NamedScene& named : scenes::marschner_lobb_scenes(arguments.points, size)) {
    if (named.name.ends_with("oblique")) result.push_back(std::move(named));
  }
  for (const scenes::RealData& data : scenes::real_data()) {
    if (arguments.tiny || data.name != "bonsai") continue;
    if (!std::filesystem::exists(data.file)) {
      std::printf("Left out, for want of data: %s.\n", data.name.c_str());
      continue;
    }
    result.push_back(scenes::real_scenes(data, size).front());
  }
  const std::size_t unlit = result.size();
  for (std::size_t i = 0; i < unlit; ++i) {
    scenes::NamedScene lit = result[i];
    lit.name += ", lit";
    lit.scene.layers[0].shading = Shading{};
    result.push_back(std::move(lit));
  }
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Frames per second on a card");
  Arguments arguments;
  app.add_option("--size", arguments.size, "Pixels along an edge of the image");
  app.add_option("--points", arguments.points, "Values along an edge of the data");
  app.add_option("--frames", arguments.frames, "Frames of a measurement");
  app.add_option("--threads", arguments.threads, "Of the CPU; 0: one per core");
  app.add_option("--pixels", arguments.pixels, "Pixels that the reference is asked for");
  app.add_option("--device", arguments.device, "cuda, or emulated to try the program");
  app.add_option("--commit", arguments.commit);
  app.add_option("--cache", arguments.cache, "Folder of reference pixels");
  app.add_flag("--tiny", arguments.tiny, "Small data and images, to try the program");
  app.add_flag("!--no-cpu", arguments.cpu, "Leave the CPU out");
  CLI11_PARSE(app, argc, argv);
  if (arguments.tiny) {
    arguments.size = arguments.points = 32;
    arguments.frames = 2;
    arguments.pixels = 128;
  }
  try {
    const Device device = arguments.device == "emulated" ? Device::emulated : Device::cuda;
    if (device == Device::cuda) {
      try {
        std::printf("Card: %s\n\n", make_cuda_backend()->name().c_str());
      } catch (const Error& error) {
        std::printf("SKIPPED: %s\n", error.what());
        return 0;
      }
    }
    std::printf("%s", bench::to_markdown(bench::environment(arguments.commit)).c_str());
    std::vector<Row> rows;
    for (const scenes::NamedScene& named : scenes_of(arguments)) {
      std::fprintf(stderr, "%s\n", named.name.c_str());
      rows.push_back(measure(named.name, named.scene, arguments, device));
    }
    print(rows, arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_device: %s\n", error.what());
    return 1;
  }
  return 0;
}
