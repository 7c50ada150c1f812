// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/light/beside_vtk.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "benchmarks/support/interleave.h"
#include "benchmarks/vtk/vtk_contenders.h"
#include "pellucid/cpu/render.h"
#include "pellucid/scene/defaults.h"

namespace pellucid::bench {
namespace {

const std::vector<double> steps{1, 0.5, 0.25, 0.1, 0.05, 0.02};

struct Difference {
  double largest = 0, rms = 0;
  double share_over = 0;  ///< of pixels with a channel that is off by more than 1/255
};

Difference difference(const Image& image, const Image& exact) {
  Difference found;
  for (std::size_t p = 0; p < exact.pixels.size(); ++p) {
    double largest = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      const double off = std::fabs(static_cast<double>(image.pixels[p][c]) -
                                   static_cast<double>(exact.pixels[p][c]));
      largest = std::max(largest, off);
      found.rms += off * off;
    }
    found.largest = std::max(found.largest, largest);
    if (largest > 1.0 / 255) ++found.share_over;
  }
  const auto pixels = static_cast<double>(exact.pixels.size());
  found.rms = std::sqrt(found.rms / (4 * pixels));
  found.share_over /= pixels;
  return found;
}

/// The same with values as floats: Mesa filters textures of bytes in some 8 bits, which shows in
/// gradients.
Subject with_floats(Subject subject) {
  std::visit(
      [&](const auto& values) {
        std::vector<float> floats(values.begin(), values.end());
        subject.volume = std::make_shared<const Volume>(subject.volume->description(),
                                                        VolumeData(std::move(floats)));
      },
      subject.volume->data());
  return subject;
}

Scene scene_of(const Layer& layer, const Volume& volume, int size) {
  Scene scene;
  scene.layers = {layer};
  if (scene.layers[0].shading) scene.layers[0].shading->flatness = 0;
  scene.size = {size, size};
  scene.camera = default_camera(volume, scene.size);
  return scene;
}

Image exact_picture(Scene scene, int threads) {
  scene.integration.tolerance = 1e-4;
  RenderOptions options;
  options.machine.threads = threads;
  return render(scene, options).image;
}

/// VTK's GPU mapper for a scene; prints why where there is none.
std::optional<Contender> gpu_mapper(const Scene& scene, int threads) {
  const VtkContenders vtk = vtk_contenders(scene, steps, threads);
  const auto found = std::ranges::find(vtk.list, "VTK GPU mapper", &Contender::name);
  if (found != vtk.list.end()) return *found;
  std::printf("%s\n", vtk.left_out.c_str());
  return std::nullopt;
}

/// Rises evenly from 0 at the least value to one per 20 voxels at the largest.
scenes::TransferPointer even_function(const Volume& volume) {
  const double least = volume.statistics().minimum, most = volume.statistics().maximum;
  return scenes::transfer(
      {{least, 0, {0.2, 0.4, 1}}, {most, 0.05 / volume.voxel_size(), {1, 0.8, 0.5}}});
}

void compare_light(const Subject& subject, const scenes::TransferPointer& function,
                   const char* function_name, const FrameArguments& arguments) {
  const Layer plain{VolumeContent{subject.volume, function, nullptr}};
  const Scene unlit = scene_of(plain, *subject.volume, arguments.size / 2);
  const Scene lit =
      scene_of(in_light(plain, GradientKind::smooth), *subject.volume, arguments.size / 2);
  std::printf("\n%s, %s, beside VTK's GPU mapper, image %d x %d\n\n", subject.name.c_str(),
              function_name, lit.size.width, lit.size.height);
  const auto gpu = gpu_mapper(lit, arguments.threads);
  const auto gpu_unlit = gpu_mapper(unlit, arguments.threads);
  if (!gpu || !gpu_unlit) return;
  const Image exact = exact_picture(lit, arguments.threads);
  const Image exact_unlit = exact_picture(unlit, arguments.threads);
  std::printf("| step, voxels | in light: largest | RMS | unlit: largest | RMS |\n");
  std::printf("|---|---|---|---|---|\n");
  for (const double step : steps) {
    const Difference in_light = difference(gpu->render(step).image, exact);
    const Difference without = difference(gpu_unlit->render(step).image, exact_unlit);
    std::printf("| %g | %.4f | %.5f | %.4f | %.5f |\n", step, in_light.largest, in_light.rms,
                without.largest, without.rms);
  }
}

}  // namespace

void compare_light_with_vtk(const Subject& given, const FrameArguments& arguments) {
  const Subject subject = with_floats(given);
  compare_light(subject, subject.function, "its function", arguments);
  compare_light(subject, even_function(*subject.volume), "an even ramp", arguments);
}

void compare_surface_with_vtk(const Subject& given, const FrameArguments& arguments) {
  const Subject subject = with_floats(given);
  const Scene scene = scene_of(in_light(surface_of(subject), GradientKind::smooth), *subject.volume,
                               arguments.size);
  std::printf("\n%s, opaque isosurface %g, beside VTK's blend mode, image %d x %d\n\n",
              subject.name.c_str(), subject.surface, scene.size.width, scene.size.height);
  const auto gpu = gpu_mapper(scene, arguments.threads);
  if (!gpu) return;
  const Image exact = exact_picture(scene, arguments.threads);
  std::vector<Image> images(steps.size() + 1);
  std::vector<std::function<double()>> ways{[&] {
    RenderOptions options;
    options.machine.threads = arguments.threads;
    RenderResult frame = render(scene, options);
    images[0] = std::move(frame.image);
    return frame.report.seconds;
  }};
  for (std::size_t i = 0; i < steps.size(); ++i) {
    ways.emplace_back([&, i] {
      TimedFrame frame = gpu->render(steps[i]);
      images[i + 1] = std::move(frame.image);
      return frame.seconds;
    });
  }
  const std::vector<double> seconds =
      interleaved_medians(ways, static_cast<std::size_t>(arguments.rounds));
  std::printf("| | ms | ours / VTK | largest | RMS | pixels over 1/255 |\n");
  std::printf("|---|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < images.size(); ++i) {
    const Difference off = difference(images[i], exact);
    if (i == 0) {
      std::printf("| ours, 1/512 | %.0f | | ", 1e3 * seconds[i]);
    } else {
      std::printf("| VTK, step of %g voxels | %.0f | %.2f | ", steps[i - 1], 1e3 * seconds[i],
                  seconds[0] / seconds[i]);
    }
    std::printf("%.4f | %.5f | %.2f %% |\n", off.largest, off.rms, 100 * off.share_over);
  }
}

}  // namespace pellucid::bench
