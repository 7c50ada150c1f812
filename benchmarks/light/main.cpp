// SPDX-License-Identifier: Apache-2.0

// What light and surfaces cost: frames in light beside the same unlit ones, and isosurfaces; and
// how far VTK's picture in the same light is from the exact one at finer and finer steps.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/support/document.h"
#include "benchmarks/support/environment.h"
#include "benchmarks/support/frame_arguments.h"
#include "benchmarks/support/interleave.h"
#include "benchmarks/vtk/vtk_contenders.h"
#include "pellucid/cpu/render.h"
#include "pellucid/scene/defaults.h"
#include "tests/scenes/makers.h"
#include "tests/scenes/real.h"

namespace {

using namespace pellucid;

using Arguments = bench::FrameArguments;

struct Subject {
  std::string name;
  scenes::VolumePointer volume;
  scenes::TransferPointer function;
  double surface;  ///< value of an isosurface
};

struct Variant {
  std::string name;
  Layer layer;
};

Layer lit(Layer layer, GradientKind gradient) {
  layer.shading = Shading{};
  layer.shading->gradient = gradient;
  return layer;
}

std::vector<Variant> variants(const Subject& subject) {
  const Layer plain{VolumeContent{subject.volume, subject.function, nullptr}};
  const double range = subject.volume->statistics().maximum - subject.volume->statistics().minimum;
  Layer weakened = plain;
  weakened.gradient_opacity = std::make_shared<const GradientOpacity>(
      std::vector<GradientOpacity::Point>{{0.01 * range, 0}, {0.05 * range, 1}},
      GradientOpacity::Unit::voxel);
  Layer surface{VolumeContent{subject.volume, scenes::transfer({{0, 0, {0, 0, 0}}}), nullptr}};
  surface.isosurfaces = {{subject.surface, 1, {0.9, 0.8, 0.7}}};
  Layer both = lit(plain, GradientKind::smooth);
  both.isosurfaces = {{subject.surface, 0.5, {0.9, 0.8, 0.7}}};
  return {{"unlit", plain},
          {"in light, smooth gradients", lit(plain, GradientKind::smooth)},
          {"in light, gradients of the field", lit(plain, GradientKind::field)},
          {"gradient opacity, unlit", weakened},
          {"opaque isosurface alone, in light", lit(surface, GradientKind::smooth)},
          {"in light, with a translucent isosurface", both}};
}

struct Difference {
  double largest = 0, rms = 0;
};

Difference difference(const Image& image, const Image& exact) {
  Difference found;
  for (std::size_t p = 0; p < exact.pixels.size(); ++p) {
    for (std::size_t c = 0; c < 4; ++c) {
      const double off = std::fabs(static_cast<double>(image.pixels[p][c]) -
                                   static_cast<double>(exact.pixels[p][c]));
      found.largest = std::max(found.largest, off);
      found.rms += off * off;
    }
  }
  found.rms = std::sqrt(found.rms / (4.0 * static_cast<double>(exact.pixels.size())));
  return found;
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
      options.threads = arguments.threads;
      options.error = true;
      render(scene, options, &reports[i]);
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

/// VTK's GPU mapper in the same light at finer and finer steps. Its normal has length 1 wherever
/// there is a gradient, and its light shines along the camera, so that the camera is parallel.
void compare_with_vtk(const Subject& subject, const Arguments& arguments) {
  Scene scene;
  scene.layers = {
      lit({VolumeContent{subject.volume, subject.function, nullptr}}, GradientKind::smooth)};
  scene.layers[0].shading->flatness = 0;
  scene.size = {arguments.size / 2, arguments.size / 2};
  scene.camera = default_camera(*subject.volume, scene.size);
  scene.camera.projection = Projection::orthographic;
  scene.camera.parallel_scale = 0.27 * length(scene.camera.position - scene.camera.focal_point);
  scene.integration.tolerance = 1e-4;
  RenderOptions options;
  options.threads = arguments.threads;
  const Image exact = render(scene, options);
  Scene unlit = scene;
  unlit.layers[0].shading.reset();
  const Image exact_unlit = render(unlit, options);
  const std::vector<double> steps{1, 0.5, 0.25, 0.1, 0.05, 0.02};
  std::printf("\n%s beside VTK's GPU mapper, image %d x %d\n\n", subject.name.c_str(),
              scene.size.width, scene.size.height);
  const bench::VtkContenders vtk = bench::vtk_contenders(scene, steps, arguments.threads);
  const bench::VtkContenders vtk_unlit = bench::vtk_contenders(unlit, steps, arguments.threads);
  const auto gpu_of = [](const bench::VtkContenders& from) {
    return std::ranges::find(from.list, "VTK GPU mapper", &bench::Contender::name);
  };
  const auto gpu = gpu_of(vtk), gpu_unlit = gpu_of(vtk_unlit);
  if (gpu == vtk.list.end() || gpu_unlit == vtk_unlit.list.end()) {
    std::printf("%s\n", vtk.left_out.c_str());
    return;
  }
  std::printf("| step, voxels | in light: largest | RMS | unlit: largest | RMS |\n");
  std::printf("|---|---|---|---|---|\n");
  for (const double step : steps) {
    const Difference in_light = difference(gpu->render(step).image, exact);
    const Difference without = difference(gpu_unlit->render(step).image, exact_unlit);
    std::printf("| %g | %.4f | %.5f | %.4f | %.5f |\n", step, in_light.largest, in_light.rms,
                without.largest, without.rms);
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
    compare_with_vtk(subject, arguments);
  }
}

}  // namespace

int main(int argc, char** argv) {
  return bench::time_frames(argc, argv, "bench_light",
                            "Frames in light beside unlit ones, and isosurfaces", 24, 24, run);
}
