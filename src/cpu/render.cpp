// SPDX-License-Identifier: Apache-2.0
#include "pellucid/cpu/render.h"

#include <tbb/blocked_range.h>
#include <tbb/blocked_range2d.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>

#include "pellucid/render/integrate_ray.h"
#include "pellucid/render/sample_ray.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/transfer_tables_storage.h"
#include "pellucid/traverse/build_block_ranges.h"

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

/// Splits work among this many threads. A thread that waits for the others does not take up work
/// from elsewhere, which might wait for it.
ParallelFor parallel_for(int threads) {
  return [threads](int count, const std::function<void(int, int)>& body) {
    tbb::task_arena arena(threads);
    arena.execute([&] {
      tbb::this_task_arena::isolate([&] {
        tbb::parallel_for(tbb::blocked_range<int>(0, count, 64),
                          [&](const auto& range) { body(range.begin(), range.end()); });
      });
    });
  };
}

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

/// The largest component of what lies behind the data.
double brightest(const std::optional<Rgb<double>>& background) {
  return background ? std::max({background->r, background->g, background->b}) : 0;
}

/// What every pixel of the frame shares.
struct Frame {
  const Scene& scene;
  CameraFrame<double> camera;
  bool depth;
  TransferTablesStorage transfer;
  RayTolerance wanted;
  const BlockRanges* blocks = nullptr;
  double reserved;  ///< of the tolerance: what the transfer function is off by

  Frame(const Scene& described, bool with_depth)
      : scene(described),
        camera(make_camera_frame(described.camera, described.size)),
        depth(with_depth),
        transfer(*described.transfer_function),
        reserved(
            described.transfer_function->approximation_error(brightest(described.background))) {
    const Integration& integration = scene.integration;
    // Rounding a pixel to binary32 costs at most half a unit in its last place.
    const double storage = storage_error(scene.transfer_function->largest_color());
    wanted.tolerance =
        std::max(integration.tolerance - reserved - storage, 0.25 * integration.tolerance);
    wanted.grade = integration.grade;
    wanted.precision = integration.precision;
    wanted.largest_color =
        std::max(scene.transfer_function->largest_color(), brightest(scene.background));
  }

  static double storage_error(double value) { return std::max(value, 1.0) * 0x1p-24; }
};

template <class Value>
RayResult render_ray(const Frame& frame, const StructuredGrid<Value, double>& grid,
                     const Ray<double>& ray_world) {
  const Scene& scene = frame.scene;
  const Ray<double> ray = scene.volume->grid_from_world().ray(ray_world);
  const Integration& integration = scene.integration;
  if (integration.method == Method::exact) {
    return integrate_ray(grid, frame.blocks, ray, frame.transfer.tables(), frame.wanted,
                         frame.depth);
  }
  const double largest_color = scene.transfer_function->largest_color();
  const double step = integration.step * scene.volume->voxel_size();
  const SamplingRule rule = sampling_rule(integration.method);
  if (integration.precision == Precision::float64) {
    return sample_ray<double>(grid, ray, frame.transfer.tables().wide, rule, step, largest_color,
                              stop_tolerance<double>(), frame.depth);
  }
  return sample_ray<float>(grid, ray, frame.transfer.tables().single, rule, step, largest_color,
                           stop_tolerance<float>(), frame.depth);
}

/// The mean of the pixel's rays. Its depth is that of the nearest.
template <class Value>
RayResult render_pixel(const Frame& frame, const StructuredGrid<Value, double>& grid, int column,
                       int row) {
  const int samples = frame.scene.samples;
  if (samples == 1) return render_ray(frame, grid, frame.camera.ray(column, row));
  RayResult mean;
  mean.error = 0;
  mean.proved = true;
  for (int n = 0; n < samples * samples; ++n) {
    const RayResult one = render_ray(frame, grid, frame.camera.ray(column, row, n, samples));
    mean.radiance = mean.radiance + one.radiance;
    mean.opacity += one.opacity;
    mean.optical_depth += one.optical_depth;
    mean.half_opacity_depth = std::min(mean.half_opacity_depth, one.half_opacity_depth);
    mean.cells += one.cells;
    mean.error += one.error;
    mean.proved = mean.proved && one.proved;
    mean.evaluations += one.evaluations;
    mean.spans += one.spans;
  }
  const double share = 1.0 / (samples * samples);
  mean.radiance = mean.radiance * share;
  mean.opacity *= share;
  mean.optical_depth *= share;
  mean.error *= share;
  return mean;
}

/// One tile's part of the report, or the whole.
void add(RenderReport& sum, const RenderReport& part) {
  sum.cells += part.cells;
  sum.largest_error = std::max(sum.largest_error, part.largest_error);
  sum.pixels_proved += part.pixels_proved;
  sum.pixels_over += part.pixels_over;
  sum.evaluations += part.evaluations;
  sum.spans += part.spans;
}

/// Puts the pixel into the image and the report.
void store(const Frame& frame, const RayResult& result, std::size_t pixel, Image& image,
           RenderReport& report) {
  const std::array<double, 4> exact{result.radiance.r, result.radiance.g, result.radiance.b,
                                    result.opacity};
  double brightest = 0;
  for (std::size_t c = 0; c < 4; ++c) {
    image.pixels[pixel][c] = static_cast<float>(exact[c]);
    brightest = std::max(brightest, exact[c]);
  }
  if (frame.depth) image.depth[pixel] = static_cast<float>(result.half_opacity_depth);
  report.cells += static_cast<std::uint64_t>(result.cells);
  report.evaluations += static_cast<std::uint64_t>(result.evaluations);
  report.spans += result.spans;

  // A clear pixel is clear whatever the transfer function is off by where it is not zero.
  const double approximation = result.opacity > 0 ? frame.reserved : 0;
  // Both the pixel and the exact one lie between zero and the largest color.
  const double most = std::max(frame.scene.transfer_function->largest_color(), 1.0);
  const double error = std::min(result.error + approximation, most) + brightest * 0x1p-24;
  if (!image.error.empty()) {
    image.error[pixel] = float_above(error);
    image.proved[pixel] = result.proved ? 1 : 0;
  }
  if (frame.scene.integration.method != Method::exact) return;
  report.largest_error = std::max(report.largest_error, error);
  if (result.proved) ++report.pixels_proved;
  if (!(error <= frame.scene.integration.tolerance)) ++report.pixels_over;
}

template <class Value>
void render_pixels(const Frame& frame, const StructuredGrid<Value, double>& grid, int threads,
                   const RenderOptions& options, Image& image, RenderReport& report) {
  constexpr std::size_t tile = 16;
  const auto width = static_cast<std::size_t>(image.width);
  const auto height = static_cast<std::size_t>(image.height);
  std::mutex report_mutex;
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
          RenderReport part;
          for (std::size_t row = range.rows().begin(); row != range.rows().end(); ++row) {
            for (std::size_t column = range.cols().begin(); column != range.cols().end();
                 ++column) {
              store(frame,
                    render_pixel(frame, grid, static_cast<int>(column), static_cast<int>(row)),
                    row * width + column, image, part);
            }
          }
          {
            const std::lock_guard lock(report_mutex);
            add(report, part);
          }
          progress.advance(range.rows().size() * range.cols().size());
        },
        context);
  });
  progress.finish();
  if (progress.cancelled()) throw Cancelled();
}

}  // namespace

Image render(const Scene& scene, const RenderOptions& options, RenderReport* report) {
  if (!scene.volume || !scene.transfer_function) {
    throw Error("scene: a volume and a transfer function are needed; set both before rendering");
  }
  check_integration(scene);
  if (options.threads < 0) throw Error("threads: must not be negative; 0 takes one per core");
  Frame frame(scene, options.depth);

  Image image;
  image.width = scene.size.width;
  image.height = scene.size.height;
  const std::size_t pixels =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  image.pixels.resize(pixels);
  if (options.depth) image.depth.resize(pixels);
  if (options.error) {
    image.error.resize(pixels);
    image.proved.resize(pixels);
  }

  RenderReport local;
  local.threads = options.threads > 0 ? options.threads : tbb::info::default_concurrency();
  local.pixels = pixels;
  local.rays = pixels * static_cast<std::uint64_t>(scene.samples) *
               static_cast<std::uint64_t>(scene.samples);
  const auto start = std::chrono::steady_clock::now();
  if (scene.integration.method == Method::exact) {
    frame.blocks = &scene.volume->block_ranges(parallel_for(local.threads));
  }
  scene.volume->visit(
      [&](const auto& grid) { render_pixels(frame, grid, local.threads, options, image, local); });
  local.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (report != nullptr) *report = local;
  return image;
}

}  // namespace pellucid
