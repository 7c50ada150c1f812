// SPDX-License-Identifier: Apache-2.0
#include "pellucid/reference/render.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <vector>

#include "camera.h"
#include "pellucid/scene/error.h"
#include "scene_integral.h"

namespace pellucid {
namespace {

/// Returns the mean of a pixel's rays; its depth is that of the nearest.
ReferencePixel mean_of(const std::vector<ReferencePixel>& rays) {
  if (rays.size() == 1) return rays.front();
  const double weight = 1 / static_cast<double>(rays.size());
  ReferencePixel mean;
  for (const ReferencePixel& ray : rays) {
    mean.radiance += ray.radiance * weight;
    mean.opacity += ray.opacity * weight;
    mean.half_opacity_depth = std::min(mean.half_opacity_depth, ray.half_opacity_depth);
  }
  return mean;
}

/// Puts a pixel over that of the backdrop.
void put_over(const std::array<float, 4>& behind, float depth, ReferencePixel& pixel) {
  const double left = 1 - pixel.opacity;
  const double own = pixel.opacity;
  pixel.radiance.r += left * static_cast<double>(behind[0]);
  pixel.radiance.g += left * static_cast<double>(behind[1]);
  pixel.radiance.b += left * static_cast<double>(behind[2]);
  pixel.opacity += left * static_cast<double>(behind[3]);
  if (!(own > 0.5 * pixel.opacity) || std::isinf(pixel.half_opacity_depth)) {
    pixel.half_opacity_depth = static_cast<double>(depth);
  }
}

void render_row(const reference::CameraRays& camera, int samples,
                const reference::SceneIntegral& integral, const Image* backdrop, int row,
                Image& image, std::uint64_t& cells) {
  const bool with_depth = !image.depth.empty();
  std::vector<ReferencePixel> rays(static_cast<std::size_t>(samples * samples));
  for (int column = 0; column < image.width; ++column) {
    const std::size_t index =
        static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
        static_cast<std::size_t>(column);
    const reference::Real end = backdrop != nullptr
                                    ? reference::Real{backdrop->depth[index]}
                                    : std::numeric_limits<reference::Real>::infinity();
    for (int n = 0; n < samples * samples; ++n) {
      rays[static_cast<std::size_t>(n)] =
          integral(camera.ray(column, row, n, samples), with_depth, cells, end);
    }
    ReferencePixel pixel = mean_of(rays);
    if (backdrop != nullptr) put_over(backdrop->pixels[index], backdrop->depth[index], pixel);
    if (!image.values.empty()) image.values[index] = static_cast<float>(rays.front().value);
    image.at(column, row) = {
        static_cast<float>(pixel.radiance.r), static_cast<float>(pixel.radiance.g),
        static_cast<float>(pixel.radiance.b), static_cast<float>(pixel.opacity)};
    if (with_depth) {
      image.depth[index] = static_cast<float>(pixel.half_opacity_depth);
    }
  }
}

}  // namespace

RenderResult render_reference(const Scene& scene, const RenderOptions& options) {
  check_data(scene);
  if (options.machine.threads < 0)
    throw Error("threads: must not be negative; 0 takes one per core");
  check_integration(scene);
  if (options.outputs.values) check_values(scene);
  make_camera_frame(scene.camera, scene.size);  // For its checks; the rays are made here.

  const reference::CameraRays camera(scene.camera, scene.size);
  const reference::SceneIntegral integral(scene);

  Image image;
  image.width = scene.size.width;
  image.height = scene.size.height;
  const auto pixels =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  image.pixels.resize(pixels);
  if (options.outputs.depth) image.depth.resize(pixels);
  if (options.outputs.values) image.values.resize(pixels);

  RenderReport local;
  local.threads =
      options.machine.threads > 0 ? options.machine.threads : tbb::info::default_concurrency();
  local.rays = pixels * static_cast<std::uint64_t>(scene.samples * scene.samples);
  const auto start = std::chrono::steady_clock::now();

  std::atomic<std::uint64_t> cells{0};
  std::mutex progress_mutex;
  int rows_done = 0;
  bool cancelled = false;
  tbb::task_group_context context;
  // More threads than cores have to be allowed, or TBB prints a warning and makes do with fewer.
  std::optional<tbb::global_control> more_threads_than_cores;
  if (local.threads > tbb::info::default_concurrency()) {
    more_threads_than_cores.emplace(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(local.threads));
  }
  tbb::task_arena(local.threads).execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<int>(0, image.height, 1),
        [&](const tbb::blocked_range<int>& rows) {
          for (int row = rows.begin(); row != rows.end(); ++row) {
            std::uint64_t row_cells = 0;
            render_row(camera, scene.samples, integral, scene.backdrop.get(), row, image,
                       row_cells);
            cells += row_cells;
            const std::lock_guard lock(progress_mutex);
            ++rows_done;
            if (cancelled || !options.monitor.progress) continue;
            if (!options.monitor.progress(static_cast<double>(rows_done) / image.height)) {
              cancelled = true;
              context.cancel_group_execution();
            }
          }
        },
        context);
  });
  if (cancelled) throw Cancelled();

  local.cells = cells;
  local.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return {std::move(image), std::move(local)};
}

}  // namespace pellucid
