// SPDX-License-Identifier: Apache-2.0
#include "pellucid/cpu/renderer.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "device/device_cache.h"
#include "layers/layer_setups.h"
#include "pellucid/scene/error.h"
#include "render_frame.h"
#include "threads.h"

namespace pellucid {

namespace {

/// Throws Error unless the memory has the size of a picture and what its outputs need.
void check_target(const ImageView& target, ImageSize size) {
  if (target.width != size.width || target.height != size.height) {
    throw Error("target: has " + std::to_string(target.width) + " x " +
                std::to_string(target.height) + " pixels, but the scene's picture " +
                std::to_string(size.width) + " x " + std::to_string(size.height));
  }
  if (target.pixels == nullptr) throw Error("target: has no memory for the color");
  if ((target.error == nullptr) != (target.proved == nullptr)) {
    throw Error("target: has memory for only one of error and proved; give both or none");
  }
}

}  // namespace

class SetupCache {
 public:
  explicit SetupCache(int of_frames) : threads(of_frames) {
    if (threads < 0) throw Error("threads: must not be negative; 0 takes one per core");
  }

  const int threads;
  LayerSetups setups;
  DeviceCache devices;

  RenderResult render(const Scene& scene, const RenderOptions& options) {
    check_frame(scene, options);
    RenderResult result;
    result.image = make_image(scene.size, options.outputs);
    result.report =
        render_frame(ImageView(result.image), scene, options, count_for(options), setups, devices);
    return result;
  }
  RenderReport render_into(const ImageView& target, const Scene& scene,
                           const RenderOptions& options) {
    RenderOptions wanted = options;
    wanted.outputs.depth = target.depth != nullptr;
    wanted.outputs.error = target.error != nullptr;
    wanted.outputs.values = target.values != nullptr;
    check_frame(scene, wanted);
    check_target(target, scene.size);
    return render_frame(target, scene, wanted, count_for(options), setups, devices);
  }
  int count_for(const RenderOptions& options) const {
    const int count = options.machine.threads > 0 ? options.machine.threads : threads;
    return count > 0 ? count : default_thread_count();
  }
};

Renderer::Renderer(int threads) : kept_(std::make_shared<SetupCache>(threads)) {}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

RenderResult Renderer::render(const Scene& scene, const RenderOptions& options) {
  return kept_->render(scene, options);
}

RenderReport Renderer::render_into(const ImageView& target, const Scene& scene,
                                   const RenderOptions& options) {
  return kept_->render_into(target, scene, options);
}

RenderResult Renderer::render_pixels(const Scene& scene, const RenderOptions& options,
                                     const std::vector<PixelRequest>& requests) {
  return pellucid::render_pixels(scene, options, requests, kept_->count_for(options),
                                 kept_->setups);
}

void Renderer::clear() {
  kept_->devices.clear();
  kept_->setups.clear();
}

/// The thread that renders, and what it tells.
struct RunningFrame::Job {
  Job(std::shared_ptr<SetupCache> with, Scene of, RenderOptions how)
      : kept(std::move(with)),
        scene(std::move(of)),
        options(std::move(how)),
        outside(options.monitor.stop, [this] { stop.request_stop(); }) {
    options.monitor.stop = stop.get_token();
    report_progress = std::exchange(options.monitor.progress, [this](double done) {
      fraction.store(done, std::memory_order_relaxed);
      return !report_progress || report_progress(done);
    });
    report_tile = std::exchange(options.monitor.tile, [this](const TileResult& tile) {
      show(tile);
      return !report_tile || report_tile(tile);
    });
    thread = std::thread([this] { run(); });
  }
  ~Job() {
    stop.request_stop();
    if (thread.joinable()) thread.join();
  }
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  void run() {
    try {
      frame = kept->render(scene, options);
      const std::lock_guard lock(showing);
      level = 0;
      shown.width = 0;  // the image itself is shown from here on
      shown.pixels.clear();
      fraction = 1;
    } catch (...) {
      error = std::current_exception();
    }
    finished.store(true, std::memory_order_release);
  }

  /// Copies a tile to what is shown; each pixel stands for those that are not rendered yet.
  void show(const TileResult& result) {
    const auto& [tile, whole] = result;
    const std::lock_guard lock(showing);
    if (shown.width == 0) {
      shown.width = whole.width;
      shown.height = whole.height;
      shown.pixels.resize(static_cast<std::size_t>(whole.width) *
                          static_cast<std::size_t>(whole.height));
      level = options.monitor.preview + 1;
    }
    // Tiles of a level follow all tiles of the coarser one.
    if (tile.level < level) level = tile.level + 1;
    const int edge = 1 << tile.level;
    for (int j = 0; j < tile.rows; ++j) {
      for (int i = 0; i < tile.columns; ++i) {
        const int column = tile.column + i * tile.stride, row = tile.row + j * tile.stride;
        const std::array<float, 4>& pixel = whole.at(column, row);
        const int right = std::min(column + edge, whole.width);
        const int below = std::min(row + edge, whole.height);
        for (int y = row; y < below; ++y) {
          std::fill(&shown.at(column, y), &shown.at(column, y) + (right - column), pixel);
        }
      }
    }
  }

  const std::shared_ptr<SetupCache> kept;
  const Scene scene;
  RenderOptions options;
  std::function<bool(double)> report_progress;
  std::function<bool(const TileResult&)> report_tile;
  std::stop_source stop;
  std::stop_callback<std::function<void()>> outside;
  std::atomic<double> fraction{0};
  std::atomic<bool> finished{false};
  RenderResult frame;
  std::exception_ptr error;
  mutable std::mutex showing;
  Image shown;     ///< of no width: nothing is shown yet, or the image is
  int level = -1;  ///< the finest level that is complete; preview + 1: none
  std::thread thread;
};

RunningFrame::RunningFrame(std::unique_ptr<Job> job) : job_(std::move(job)) {}
RunningFrame::RunningFrame(RunningFrame&&) noexcept = default;
RunningFrame& RunningFrame::operator=(RunningFrame&&) noexcept = default;
RunningFrame::~RunningFrame() = default;

void RunningFrame::cancel() noexcept {
  job_->stop.request_stop();
}

bool RunningFrame::finished() const noexcept {
  return job_->finished.load(std::memory_order_acquire);
}

RunningFrame::State RunningFrame::state() const {
  State state;
  state.finished = finished();
  state.fraction = job_->fraction;
  const std::lock_guard lock(job_->showing);
  state.level = job_->level > job_->options.monitor.preview ? -1 : job_->level;
  return state;
}

Image RunningFrame::look() const {
  const std::lock_guard lock(job_->showing);
  if (job_->level == 0) {
    Image copy;
    const Image& image = job_->frame.image;
    copy.width = image.width;
    copy.height = image.height;
    copy.pixels = image.pixels;
    return copy;
  }
  if (job_->shown.width > 0) return job_->shown;
  Image nothing;
  nothing.width = job_->scene.size.width;
  nothing.height = job_->scene.size.height;
  nothing.pixels.resize(static_cast<std::size_t>(nothing.width) *
                        static_cast<std::size_t>(nothing.height));
  return nothing;
}

RenderResult RunningFrame::wait() {
  if (job_->thread.joinable()) job_->thread.join();
  if (job_->error) std::rethrow_exception(job_->error);
  const std::lock_guard lock(job_->showing);
  return {std::exchange(job_->frame.image, {}), job_->frame.report};
}

struct SteppedFrame::Job {
  Job(std::shared_ptr<SetupCache> with, Scene of, RenderOptions how)
      : kept(std::move(with)),
        scene(std::move(of)),
        options(std::move(how)),
        image(make_image(scene.size, options.outputs)),
        view(image),
        work(view, scene, options, kept->count_for(options), kept->setups, kept->devices) {}

  const std::shared_ptr<SetupCache> kept;
  const Scene scene;
  const RenderOptions options;
  Image image;
  const ImageView view;
  FrameWork work;
  bool is_done = false;
};

SteppedFrame::SteppedFrame(std::unique_ptr<Job> job) : job_(std::move(job)) {}
SteppedFrame::SteppedFrame(SteppedFrame&&) noexcept = default;
SteppedFrame& SteppedFrame::operator=(SteppedFrame&&) noexcept = default;
SteppedFrame::~SteppedFrame() = default;

bool SteppedFrame::advance(double seconds) {
  if (!(seconds >= 0)) throw Error("seconds: must not be negative");
  if (job_->is_done) return true;
  const auto most = std::chrono::duration<double>(std::min(seconds, endless.count()));
  return job_->is_done = job_->work.advance(most);
}

RenderResult SteppedFrame::take() {
  if (!job_->is_done) throw Error("the frame is not done; advance() it until it is");
  return {std::exchange(job_->image, {}), job_->work.report()};
}

SteppedFrame Renderer::begin(Scene scene, RenderOptions options) {
  check_frame(scene, options);
  return SteppedFrame(
      std::make_unique<SteppedFrame::Job>(kept_, std::move(scene), std::move(options)));
}

RunningFrame Renderer::start(Scene scene, RenderOptions options) {
  return RunningFrame(
      std::make_unique<RunningFrame::Job>(kept_, std::move(scene), std::move(options)));
}

RenderResult render(const Scene& scene, const RenderOptions& options) {
  return Renderer().render(scene, options);
}

RenderReport render_into(const ImageView& target, const Scene& scene,
                         const RenderOptions& options) {
  return Renderer().render_into(target, scene, options);
}

}  // namespace pellucid
