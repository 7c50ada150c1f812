// SPDX-License-Identifier: Apache-2.0

// The maximum projection beside that of VTK's fixed-point mapper: time, and how far VTK's picture
// is from the exact one at finer and finer steps.

#include <algorithm>
#include <cmath>
#include <cstdint>
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

/// Thin vessels in noise, of bytes: helices one voxel thick, whose brightness varies.
scenes::VolumePointer vessels(int points) {
  const auto n = static_cast<std::size_t>(points);
  std::vector<std::uint8_t> data(n * n * n);
  std::uint32_t state = 1;
  for (std::uint8_t& value : data) {
    state = 1664525 * state + 1013904223;
    value = static_cast<std::uint8_t>(state >> 26);
  }
  const double last = points - 1;
  for (int helix = 0; helix < 6; ++helix) {
    for (int i = 0; i < 20 * points; ++i) {
      const double t = i / (20.0 * points), angle = 9 * t + helix;
      const double place[3] = {0.5 + (0.1 + 0.06 * helix) * std::cos(angle),
                               0.5 + (0.1 + 0.06 * helix) * std::sin(angle), t};
      std::size_t at = 0;
      for (int a = 2; a >= 0; --a) {
        at = at * n + static_cast<std::size_t>(std::lround(place[a] * last));
      }
      data[at] = static_cast<std::uint8_t>(160 + 15 * helix);
    }
  }
  return std::make_shared<const Volume>(scenes::grid_description({points, points, points}),
                                        VolumeData(std::move(data)));
}

/// In greys over the range, opaque for VTK too, whose opacity is that of one voxel.
Scene scene_of(const scenes::VolumePointer& volume, int size) {
  const VolumeStatistics& data = volume->statistics();
  constexpr double opaque = 1e3;
  Layer layer{VolumeContent{
      volume,
      scenes::transfer({{data.minimum, opaque, {0, 0, 0}}, {data.maximum, opaque, {1, 1, 1}}}),
      nullptr}};
  layer.projection = LayerProjection::maximum;
  Scene scene;
  scene.layers = {layer};
  scene.size = {size, size};
  scene.camera = default_camera(*volume, scene.size);
  return scene;
}

struct Difference {
  double largest = 0, mean = 0;
};

/// Of the pixels that both show; edges of the box are one pixel's matter.
Difference difference(const Image& image, const Image& exact) {
  Difference found;
  std::size_t count = 0;
  for (std::size_t p = 0; p < exact.pixels.size(); ++p) {
    if (!(image.pixels[p][3] > 0.99F && exact.pixels[p][3] > 0.99F)) continue;
    const double off = std::fabs(static_cast<double>(image.pixels[p][0] - exact.pixels[p][0]));
    found.largest = std::max(found.largest, off);
    found.mean += off;
    ++count;
  }
  if (count > 0) found.mean /= static_cast<double>(count);
  return found;
}

void compare(const std::string& name, const scenes::VolumePointer& volume,
             const Arguments& arguments) {
  const Scene scene = scene_of(volume, arguments.size);
  RenderOptions options;
  options.machine.threads = arguments.threads;
  options.outputs.error = true;
  const auto [exact, report] = render(scene, options);
  options.outputs.error = false;
  const std::vector<double> steps{1, 0.5, 0.25, 0.1, 0.05};
  const bench::VtkContenders vtk = bench::vtk_contenders(scene, steps, arguments.threads);
  std::vector<std::function<double()>> ways{[&] {
    RenderReport one;
    one = render(scene, options).report;
    return one.seconds;
  }};
  const bench::Contender* const fixed = vtk.list.empty() ? nullptr : vtk.list.data();
  std::vector<Image> pictures(steps.size());
  for (std::size_t i = 0; fixed != nullptr && i < steps.size(); ++i) {
    ways.emplace_back([&, i] {
      bench::TimedFrame frame = fixed->render(steps[i]);
      pictures[i] = std::move(frame.image);
      return frame.seconds;
    });
  }
  const std::vector<double> seconds =
      bench::interleaved_medians(ways, static_cast<std::size_t>(arguments.rounds));
  const auto& d = volume->description().dimensions;
  std::printf("\n%s, %d x %d x %d, image %d x %d, %d threads\n", name.c_str(), d[0], d[1], d[2],
              arguments.size, arguments.size, arguments.threads);
  std::printf("  pellucid, exact:        %8.1f ms, %5.1f cells a ray, largest error %.1e\n",
              1e3 * seconds[0],
              static_cast<double>(report.cells) / static_cast<double>(report.rays),
              report.largest_error);
  for (std::size_t i = 0; fixed != nullptr && i < steps.size(); ++i) {
    const Difference off = difference(pictures[i], exact);
    std::printf("  VTK, step %4.2f voxels:  %8.1f ms, off by %.4f at most, %.5f in the mean\n",
                steps[i], 1e3 * seconds[i + 1], off.largest, off.mean);
  }
  if (fixed == nullptr) std::printf("  %s\n", vtk.left_out.c_str());
  for (const LayerProjection projection :
       {LayerProjection::minimum, LayerProjection::mean, LayerProjection::sum}) {
    Scene other = scene;
    other.layers[0].projection = projection;
    RenderReport one;
    one = render(other, options).report;
    std::printf("  pellucid, %-8s       %8.1f ms, %5.1f cells a ray\n",
                (std::string(projection_name(projection)) + ":").c_str(), 1e3 * one.seconds,
                static_cast<double>(one.cells) / static_cast<double>(one.rays));
  }
}

void run(const Arguments& arguments) {
  std::printf("%s", bench::to_markdown(bench::environment("")).c_str());
  compare("vessels", vessels(arguments.points), arguments);
  if (arguments.tiny) return;
  for (const scenes::RealData& data : scenes::real_data()) {
    if (std::filesystem::exists(data.file)) compare(data.name, scenes::read(data), arguments);
  }
}

}  // namespace

int main(int argc, char** argv) {
  return bench::time_frames(argc, argv, "bench_projections", "The maximum projection beside VTK's",
                            32, 32, run);
}
