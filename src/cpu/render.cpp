// SPDX-License-Identifier: Apache-2.0
#include "pellucid/cpu/render.h"

#include <tbb/blocked_range2d.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <sstream>

#include "pellucid/render/integrate_ray.h"
#include "pellucid/render/sample_ray.h"
#include "pellucid/scene/error.h"

namespace pellucid {
namespace {

/// Counts finished pixels and asks the caller now and then whether to go on.
class Progress {
 public:
  Progress(const std::function<bool(double)>& callback, std::uint64_t total,
           tbb::task_group_context& context)
      : callback_(callback), total_(total), context_(context) {}

  void advance(std::uint64_t count) {
    done_ += count;
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (lock.owns_lock()) report();
  }
  /// The last word, in case another thread was asking when the last pixel was done.
  void finish() { report(); }
  bool cancelled() const { return cancelled_; }

 private:
  void report() {
    const std::uint64_t done = done_;
    if (!callback_ || cancelled_ || done <= reported_) return;
    reported_ = done;
    if (!callback_(static_cast<double>(done) / static_cast<double>(total_))) {
      cancelled_ = true;
      context_.cancel_group_execution();
    }
  }

  const std::function<bool(double)>& callback_;
  const std::uint64_t total_;
  tbb::task_group_context& context_;
  std::atomic<std::uint64_t> done_{0};
  std::mutex mutex_;
  std::uint64_t reported_ = 0;  ///< under the mutex, or when all threads are done
  std::atomic<bool> cancelled_{false};
};

SamplingRule sampling_rule(Method method) {
  switch (method) {
    case Method::rectangle:
      return SamplingRule::rectangle;
    case Method::taylor:
      return SamplingRule::taylor;
    case Method::midpoint:
      return SamplingRule::midpoint;
    case Method::trapezoid:
      return SamplingRule::trapezoid;
    case Method::simpson:
      return SamplingRule::simpson;
    case Method::linear:
    case Method::exact:
      break;
  }
  return SamplingRule::linear;
}

struct Frame {
  const Scene& scene;
  CameraFrame<double> camera;
  bool depth;
};

template <class T, class Value>
RayResult render_pixel(const Frame& frame, const StructuredGrid<Value, double>& grid, int column,
                       int row) {
  const Scene& scene = frame.scene;
  const Ray<double> ray = scene.volume->grid_from_world().ray(frame.camera.ray(column, row));
  const PiecewiseLinear<T> transfer = scene.transfer_function->view<T>();
  const double largest_color = scene.transfer_function->largest_color();
  if (scene.integration.method == Method::exact) {
    return integrate_ray<T>(grid, ray, transfer, largest_color, frame.depth);
  }
  const double step = scene.integration.step * scene.volume->voxel_size();
  return sample_ray<T>(grid, ray, transfer, sampling_rule(scene.integration.method), step,
                       largest_color, stop_tolerance<T>(), frame.depth);
}

template <class T, class Value>
void render_pixels(const Frame& frame, const StructuredGrid<Value, double>& grid, int threads,
                   const RenderOptions& options, Image& image, RenderReport& report) {
  constexpr std::size_t tile = 16;
  const auto width = static_cast<std::size_t>(image.width);
  const auto height = static_cast<std::size_t>(image.height);
  std::atomic<std::uint64_t> cells{0};
  tbb::task_group_context context;
  Progress progress(options.progress, width * height, context);
  // oneTBB keeps to the number of cores, and prints a warning, unless it is told otherwise.
  std::optional<tbb::global_control> more_threads_than_cores;
  if (threads > tbb::info::default_concurrency()) {
    more_threads_than_cores.emplace(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
  }
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range2d<std::size_t>(0, height, tile, 0, width, tile),
        [&](const tbb::blocked_range2d<std::size_t>& range) {
          std::uint64_t tile_cells = 0;
          for (std::size_t row = range.rows().begin(); row != range.rows().end(); ++row) {
            for (std::size_t column = range.cols().begin(); column != range.cols().end();
                 ++column) {
              const RayResult result =
                  render_pixel<T>(frame, grid, static_cast<int>(column), static_cast<int>(row));
              const std::size_t pixel = row * width + column;
              image.pixels[pixel] = {
                  static_cast<float>(result.radiance.r), static_cast<float>(result.radiance.g),
                  static_cast<float>(result.radiance.b), static_cast<float>(result.opacity)};
              if (frame.depth) image.depth[pixel] = static_cast<float>(result.half_opacity_depth);
              tile_cells += static_cast<std::uint64_t>(result.cells);
            }
          }
          cells += tile_cells;
          progress.advance(range.rows().size() * range.cols().size());
        },
        context);
  });
  progress.finish();
  if (progress.cancelled()) throw Cancelled();
  report.cells = cells;
}

}  // namespace

Image render(const Scene& scene, const RenderOptions& options, RenderReport* report) {
  if (!scene.volume || !scene.transfer_function) {
    throw Error("scene: a volume and a transfer function are needed; set both before rendering");
  }
  const double step = scene.integration.step;
  if (scene.integration.method != Method::exact &&
      !(step >= smallest_step && step <= largest_step)) {
    std::ostringstream message;
    message << "integration: step is " << step << " voxels, but must be from " << smallest_step
            << " to " << largest_step;
    throw Error(message.str());
  }
  if (options.threads < 0) throw Error("threads: must not be negative; 0 takes one per core");
  const Frame frame{scene, make_camera_frame(scene.camera, scene.size), options.depth};

  Image image;
  image.width = scene.size.width;
  image.height = scene.size.height;
  const std::size_t pixels =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  image.pixels.resize(pixels);
  if (options.depth) image.depth.resize(pixels);

  RenderReport local;
  local.threads = options.threads > 0 ? options.threads : tbb::info::default_concurrency();
  local.rays = pixels;
  const auto start = std::chrono::steady_clock::now();
  scene.volume->visit([&](const auto& grid) {
    if (scene.integration.precision == Precision::float32) {
      render_pixels<float>(frame, grid, local.threads, options, image, local);
    } else {
      render_pixels<double>(frame, grid, local.threads, options, image, local);
    }
  });
  local.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (report != nullptr) *report = local;
  return image;
}

}  // namespace pellucid
