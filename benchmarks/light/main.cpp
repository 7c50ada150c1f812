// SPDX-License-Identifier: Apache-2.0

// What light and surfaces cost: frames in light beside the same unlit ones, and isosurfaces; and
// how far VTK's pictures of the same are from the exact ones at finer and finer steps.

#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/light/beside_vtk.h"
#include "benchmarks/light/subject.h"
#include "benchmarks/support/document.h"
#include "benchmarks/support/environment.h"
#include "benchmarks/support/frame_arguments.h"
#include "benchmarks/support/interleave.h"
#include "pellucid/cpu/render.h"
#include "pellucid/scene/defaults.h"
#include "tests/scenes/makers.h"
#include "tests/scenes/real.h"

namespace {

using namespace pellucid;

using Arguments = bench::FrameArguments;
using bench::Subject;

struct Variant {
  std::string name;
  Layer layer;
};

std::vector<Variant> variants(const Subject& subject) {
  const Layer plain{VolumeContent{subject.volume, subject.function, nullptr}};
  const double range = subject.volume->statistics().maximum - subject.volume->statistics().minimum;
  Layer weakened = plain;
  weakened.gradient_opacity = std::make_shared<const GradientOpacity>(
      std::vector<GradientOpacity::Point>{{0.01 * range, 0}, {0.05 * range, 1}},
      GradientOpacity::Unit::voxel);
  Layer both = bench::in_light(plain, GradientKind::smooth);
  both.isosurfaces = {{subject.surface, 0.5, {0.9, 0.8, 0.7}}};
  return {{"unlit", plain},
          {"in light, smooth gradients", bench::in_light(plain, GradientKind::smooth)},
          {"in light, gradients of the field", bench::in_light(plain, GradientKind::field)},
          {"gradient opacity, unlit", weakened},
          {"opaque isosurface alone, in light",
           bench::in_light(bench::surface_of(subject), GradientKind::smooth)},
          {"in light, with a translucent isosurface", both}};
}

void measure(const Subject& subject, const Arguments& arguments) {
  std::vector<std::function<double()>> ways;
  const std::vector<Variant> list = variants(subject);
  std::vector<RenderReport> reports(list.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    ways.emplace_back([&, i] {
      Scene scene;
      scene.layers = {list[i].layer};
      scene.size = {arguments.size, arguments.size};
      scene.camera = default_camera(*subject.volume, scene.size);
      RenderOptions options;
      options.machine.threads = arguments.threads;
      options.outputs.error = true;
      reports[i] = render(scene, options).report;
      return reports[i].seconds;
    });
  }
  const std::vector<double> seconds =
      bench::interleaved_medians(ways, static_cast<std::size_t>(arguments.rounds));
  const auto& d = subject.volume->description().dimensions;
  std::printf("\n%s, %d x %d x %d, image %d x %d, tolerance 1/512, %d threads\n\n",
              subject.name.c_str(), d[0], d[1], d[2], arguments.size, arguments.size,
              arguments.threads);
  std::printf("| | ms | of unlit | over the tolerance |\n|---|---|---|---|\n");
  for (std::size_t i = 0; i < list.size(); ++i) {
    std::printf("| %s | %.0f | %.2f | %llu |\n", list[i].name.c_str(), 1e3 * seconds[i],
                seconds[i] / seconds[0],
                static_cast<unsigned long long>(reports[i].pixels_over_tolerance));
  }
}

void run(const Arguments& arguments) {
  std::printf("%s", bench::to_markdown(bench::environment("")).c_str());
  measure({"spike", scenes::builtin("marschner_lobb", arguments.points),
           scenes::transfer(
               {{0.49, 0, {1, 0.7, 0.3}}, {0.5, 40, {1, 0.8, 0.5}}, {0.51, 0, {0.7, 0.8, 1}}}),
           0.5},
          arguments);
  if (arguments.tiny) return;
  const double surfaces[] = {60, 110, 50};
  std::size_t n = 0;
  for (const scenes::RealData& data : scenes::real_data()) {
    if (n == 3) break;
    const double surface = surfaces[n++];
    if (!std::filesystem::exists(data.file)) continue;
    const Subject subject{data.name, scenes::read(data), scenes::transfer(data.points), surface};
    measure(subject, arguments);
    bench::compare_light_with_vtk(subject, arguments);
    bench::compare_surface_with_vtk(subject, arguments);
  }
}

}  // namespace

int main(int argc, char** argv) {
  return bench::time_frames(argc, argv, "bench_light",
                            "Frames in light beside unlit ones, and isosurfaces", 24, 24, run);
}
