// SPDX-License-Identifier: Apache-2.0
#include <pellucid/pellucid.h>
#include <pellucid/scene/builtin_fields.h>
#include <pellucid/scene/error.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <thread>

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// Turns the camera about the axis that is up, by some degrees.
void orbit(pellucid::Camera& camera, double degrees) {
  const pellucid::Vec3<double> from = camera.position - camera.focal_point;
  const pellucid::Vec3<double> up = (1 / length(camera.up)) * camera.up;
  const double angle = degrees * 3.14159265358979 / 180;
  camera.position = camera.focal_point + std::cos(angle) * from +
                    std::sin(angle) * cross(up, from) + (1 - std::cos(angle)) * dot(up, from) * up;
}

// turn [FILE [SECONDS [PIXELS]]]
int main(int argc, char** argv) {
  try {
    const pellucid::Volume data =
        argc > 1 ? pellucid::read_volume(argv[1]) : pellucid::make_builtin_field("shells", 64);
    const double seconds = argc > 2 ? std::atof(argv[2]) : 5;
    const int pixels = argc > 3 ? std::atoi(argv[3]) : 512;
    const pellucid::Layer layer(data, pellucid::default_transfer_function(data));
    pellucid::Scene scene(layer, {pixels, pixels});

    pellucid::Renderer renderer;  // keeps what frames share
    pellucid::RenderOptions options;
    options.monitor.preview = 3;  // every eighth pixel along each axis first
    pellucid::RenderReport report = renderer.render(scene, options).report;
    std::printf("first frame: %.0f ms, of these set-up %.2f ms\n", 1e3 * report.seconds,
                1e3 * report.setup_seconds);

    // Whole frames.
    int frames = 0;
    double setup = 0;
    const auto begin = Clock::now();
    while (milliseconds_since(begin) < 500 * seconds) {
      orbit(scene.camera, 3);
      report = renderer.render(scene, options).report;
      setup = std::max(setup, report.setup_seconds);
      ++frames;
    }
    std::printf("%.1f frames per second, each to 1/512; longest set-up %.2f ms\n",
                1e3 * frames / milliseconds_since(begin), 1e3 * setup);

    // Frames that the next move of the mouse cancels: coarse levels are seen all the same.
    int moves = 0, seen = 0;
    double coarse = 0, wait = 0;
    const auto moving = Clock::now();
    while (milliseconds_since(moving) < 500 * seconds) {
      orbit(scene.camera, 3);
      const auto start = Clock::now();
      pellucid::RunningFrame frame = renderer.start(scene, options);
      double first = 0;
      while (milliseconds_since(start) < 50 && !frame.finished()) {
        if (first == 0 && frame.state().level >= 0) first = milliseconds_since(start);
        std::this_thread::sleep_for(std::chrono::microseconds(500));
      }
      ++moves;
      if (first > 0) ++seen;
      coarse = std::max(coarse, first);
      const auto cancelled = Clock::now();
      frame.cancel();
      try {
        frame.wait();
      } catch (const pellucid::Cancelled&) {
      }
      wait = std::max(wait, milliseconds_since(cancelled));
    }
    std::printf("%d moves, %d with a coarse picture, after %.1f ms at most\n", moves, seen, coarse);
    std::printf("longest wait after a cancel: %.1f ms\n", wait);
  } catch (const pellucid::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
