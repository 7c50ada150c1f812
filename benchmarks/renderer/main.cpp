// SPDX-License-Identifier: Apache-2.0

// What a Renderer's frames cost beside the rays: set-up after a move of the camera and with a new
// transfer function, the wait for the first coarse level, and for the threads after a cancel.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "benchmarks/support/environment.h"
#include "pellucid/cpu/renderer.h"
#include "pellucid/io/read_volume.h"
#include "pellucid/scene/builtin_fields.h"
#include "pellucid/scene/defaults.h"
#include "pellucid/scene/error.h"

namespace {

using Clock = std::chrono::steady_clock;
using namespace pellucid;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

struct Milliseconds {
  std::vector<double> all;
  void print(const char* what) {
    std::sort(all.begin(), all.end());
    std::printf("| %s | %.2f | %.2f |\n", what, all[all.size() / 2], all.back());
  }
};

Scene scene_of(const std::shared_ptr<const Volume>& volume, int size) {
  Scene scene;
  scene.layers = {{VolumeContent{
      volume, std::make_shared<const TransferFunction>(default_transfer_function(*volume)),
      nullptr}}};
  scene.size = {size, size};
  scene.camera = default_camera(*volume, scene.size);
  return scene;
}

void move_camera(Scene& scene) {
  scene.camera.position =
      1.01 * scene.camera.position - 0.01 * scene.camera.focal_point + Vec3<double>{1e-3, 0, 0};
}

/// The same function with more extinction, as a new object.
void change_function(Scene& scene) {
  auto& content = std::get<VolumeContent>(scene.layers[0].content);
  std::vector<TransferFunction::Point> points = content.transfer_function->points();
  for (TransferFunction::Point& point : points) point.extinction *= 1.03;
  content.transfer_function = std::make_shared<const TransferFunction>(points);
}

void measure_setup(const std::shared_ptr<const Volume>& volume, int repeats,
                   const std::string& name) {
  Renderer renderer;
  Scene scene = scene_of(volume, 16);
  RenderReport report;
  report = renderer.render(scene).report;
  Milliseconds moved, changed;
  for (int i = 0; i < repeats; ++i) {
    move_camera(scene);
    report = renderer.render(scene).report;
    moved.all.push_back(1e3 * report.setup_seconds);
    change_function(scene);
    report = renderer.render(scene).report;
    changed.all.push_back(1e3 * report.setup_seconds);
  }
  moved.print((name + ": set-up, the camera moved").c_str());
  changed.print((name + ": set-up, a new transfer function").c_str());
}

void measure_waits(const std::shared_ptr<const Volume>& volume, int repeats, int size,
                   const std::string& name) {
  Renderer renderer;
  Scene scene = scene_of(volume, size);
  RenderOptions options;
  options.monitor.preview = 3;
  renderer.render(scene, options);
  Milliseconds coarse, cancelled;
  for (int i = 0; i < repeats; ++i) {
    move_camera(scene);
    const auto start = Clock::now();
    RunningFrame frame = renderer.start(scene, options);
    while (frame.state().level < 0 && !frame.finished()) {
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    coarse.all.push_back(milliseconds_since(start));
    // At another place of the frame each time.
    std::this_thread::sleep_for(std::chrono::milliseconds(1 + 7 * i % 150));
    const auto asked = Clock::now();
    frame.cancel();
    try {
      frame.wait();
    } catch (const Cancelled&) {
    }
    cancelled.all.push_back(milliseconds_since(asked));
  }
  coarse.print((name + ": first coarse level").c_str());
  cancelled.print((name + ": wait after a cancel").c_str());
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Times of a renderer's frames beside the rays");
  std::string file = "/usr/share/mricron/templates/ch2.nii.gz";
  int repeats = 40, size = 512, small = 256, large = 512;
  bool tiny = false;
  app.add_option("--file", file, "Volume for the waits");
  app.add_option("--repeats", repeats);
  app.add_option("--size", size, "Image of the waits, pixels along an edge");
  app.add_flag("--tiny", tiny, "Small data, for trying the program");
  CLI11_PARSE(app, argc, argv);
  if (tiny) repeats = 3, size = 64, small = 32, large = 48;
  try {
    std::printf("%s\n", bench::to_markdown(bench::environment("")).c_str());
    std::printf("| what | median, ms | longest, ms |\n|---|---|---|\n");
    for (const int points : {small, large}) {
      const auto volume =
          std::make_shared<const Volume>(make_builtin_field("marschner_lobb", points));
      measure_setup(volume, repeats, std::to_string(points) + "³");
    }
    const auto volume = std::make_shared<const Volume>(
        tiny ? make_builtin_field("marschner_lobb", small) : read_volume(file));
    measure_waits(volume, repeats, size, tiny ? "tiny" : file);
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
