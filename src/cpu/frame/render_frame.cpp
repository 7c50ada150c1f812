// SPDX-License-Identifier: Apache-2.0
#include "render_frame.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "device/device_frame.h"
#include "frame.h"
#include "pellucid/scene/error.h"
#include "pixel_interpolator.h"
#include "progress.h"
#include "render_tile.h"
#include "threads.h"
#include "tiles.h"

namespace pellucid {
namespace {

/// Throws Error if the scene cannot be rendered in a region: a part of a pixel is composited ray by
/// ray, and a projection is no composite.
void check_region(const Scene& scene) {
  const bool projects = std::ranges::any_of(
      scene.layers, [](const Layer& layer) { return layer.visible && layer.projection; });
  if (projects || scene.samples != 1 || scene.integration.method != Method::exact) {
    throw Error(
        "region: needs the method exact, one sample per pixel, and no projected layer; leave the "
        "region out");
  }
}

}  // namespace

void check_frame(const Scene& scene, const RenderOptions& options) {
  check_data(scene);
  check_integration(scene);
  check_method(scene);
  if (options.outputs.values) check_values(scene);
  if (options.outputs.region) check_region(scene);
  if (options.machine.threads < 0)
    throw Error("threads: must not be negative; 0 takes one per core");
  if (options.monitor.preview < 0 || options.monitor.preview > largest_preview) {
    throw Error("preview: " + std::to_string(options.monitor.preview) +
                " levels, but must be from 0 to " + std::to_string(largest_preview));
  }
  make_camera_frame(scene.camera, scene.size);
}

namespace {

/// Returns the tiles from the `first` on, in their order from coarse to fine, whose pixels are
/// multiples of `stride`.
std::span<const Tile> tiles_of(const std::vector<Tile>& tiles, std::size_t first, int stride) {
  std::size_t end = first;
  while (end < tiles.size() && 1 << tiles[end].level >= stride) ++end;
  return std::span(tiles).subspan(first, end - first);
}

}  // namespace

std::string_view device_name(Device device) noexcept {
  if (device == Device::cuda) return "cuda";
  return device == Device::cpu ? "cpu" : "emulated";
}

Image make_image(ImageSize size, const FrameOutputs& outputs) {
  Image image;
  image.width = size.width;
  image.height = size.height;
  const std::size_t pixels =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  image.pixels.resize(pixels);
  if (outputs.depth) image.depth.resize(pixels);
  if (outputs.values) image.values.resize(pixels);
  if (outputs.error) {
    image.error.resize(pixels);
    image.proved.resize(pixels);
  }
  return image;
}

/// The tiles of a frame, level by level, and how far they are.
struct FrameWork::Tiles {
  Tiles(const ImageView& image, const Scene& scene, const RenderOptions& options, int threads,
        LayerSetups& kept)
      : frame(scene, options, threads, kept),
        all(make_tiles(scene.size, options.monitor.preview)),
        progress(options, image, all),
        between(PixelInterpolator::make(frame, image)) {}

  const Frame frame;
  const std::vector<Tile> all;
  Progress progress;
  TileSpeed speed;
  const std::unique_ptr<PixelInterpolator> between;
  std::mutex report_mutex;

  // The level that is being rendered; 0: none is yet.
  int level = 0;
  std::span<const Tile> of_level{};
  std::vector<Tile> lattice;  ///< those of a level that is not told of
  bool is_told_of = true;     ///< whether they are tiles of the preview
  std::size_t begun = 0;      ///< tiles of this level
  std::size_t next_tile = 0;  ///< of all: the first of the next level
};

FrameWork::FrameWork(const ImageView& image, const Scene& scene, const RenderOptions& options,
                     int threads, LayerSetups& kept, DeviceCache& devices)
    : image_(image), scene_(scene), options_(options), kept_(kept), devices_(devices) {
  report_.threads = threads;
  report_.pixels =
      static_cast<std::uint64_t>(image.width) * static_cast<std::uint64_t>(image.height);
}

FrameWork::~FrameWork() = default;

double FrameWork::seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

bool FrameWork::advance(std::chrono::duration<double> time) {
  const Clock::time_point start = Clock::now();
  const bool is_endless = time > std::chrono::hours(24);
  const Clock::time_point end = is_endless
                                    ? Clock::time_point::max()
                                    : start + std::chrono::duration_cast<Clock::duration>(time);
  const double before = report_.seconds;
  const bool is_done = (!tiles_ && begin(start)) || render_tiles(end);
  report_.seconds = before + seconds_since(start);
  return is_done;
}

/// Sets the frame up. Returns whether a device rendered it, to its end.
bool FrameWork::begin(Clock::time_point start) {
  const Device wanted = options_.machine.device;
  const std::shared_ptr<CachedDevice> device =
      wanted == Device::cpu ? nullptr : devices_.find(wanted);
  tiles_ = std::make_unique<Tiles>(image_, scene_, options_, report_.threads, kept_);
  const Frame& frame = tiles_->frame;
  report_.setup_seconds = seconds_since(start);
  report_.sampled_in_float = scene_.integration.method != Method::exact && frame.only_layer &&
                             frame.only_layer->fast() != nullptr;
  if (!device) return false;
  const std::string reason = reason_for_cpu(frame, options_);
  if (!reason.empty()) {
    report_.device = "rendered by the CPU: devices cannot do " + reason + " yet";
    return false;
  }
  render_on_device(frame, options_, *device, image_, report_);
  return true;
}

bool FrameWork::render_tiles(Clock::time_point end) {
  if (tiles_->level == 0) next_level();
  while (true) {
    if (!render_level(end)) return false;
    if (tiles_->level == 1) break;
    end_level();
    next_level();
  }
  tiles_->progress.finish();
  if (tiles_->progress.cancelled()) throw Cancelled();
  return true;
}

/// Renders the tiles that are left of a level. Returns false where the time has come.
bool FrameWork::render_level(Clock::time_point end) {
  Tiles& tiles = *tiles_;
  const std::span<const Tile> left = tiles.of_level.subspan(tiles.begun);
  std::atomic<std::size_t> begun{0};
  parallel_for_ordered(left.size(), report_.threads, [&](std::size_t i) {
    begun.fetch_add(1, std::memory_order_relaxed);
    RenderReport part;
    const std::size_t pixels = render_tile(
        tiles.frame, left[i],
        {tiles.level, tiles.between.get(), options_.monitor.stop, &tiles.speed}, image_, part);
    if (options_.monitor.stop.stop_requested()) return false;
    {
      const std::lock_guard lock(tiles.report_mutex);
      add(report_, part);
    }
    if (tiles.is_told_of) {
      tiles.progress.finish_tile(left[i], pixels);
    } else {
      tiles.progress.finish_pixels(pixels);
    }
    return !tiles.progress.cancelled() && (end == Clock::time_point::max() || Clock::now() < end);
  });
  if (options_.monitor.stop.stop_requested() || tiles.progress.cancelled()) throw Cancelled();
  tiles.begun += begun;  // those that were begun are done, and are the first ones
  return tiles.begun == tiles.of_level.size();
}

void FrameWork::end_level() {
  tiles_->between->finish_level(tiles_->level, report_.threads);
}

/// Chooses the level that comes next: of pixels that others are interpolated between, or all that
/// is left.
void FrameWork::next_level() {
  Tiles& tiles = *tiles_;
  const int first = tiles.between ? tiles.between->stride() : 1;
  tiles.level = tiles.level == 0 ? first : tiles.level / 2;
  if (tiles.level > 1 && !tiles.between->goes_on()) tiles.level = 1;
  tiles.begun = 0;
  tiles.is_told_of = tiles.level == 1 || 1 << options_.monitor.preview >= tiles.level;
  if (tiles.is_told_of) {
    tiles.of_level = tiles_of(tiles.all, tiles.next_tile, tiles.level);
    tiles.next_tile += tiles.of_level.size();
  } else {
    tiles.lattice = make_lattice(scene_.size, tiles.level);
    tiles.of_level = tiles.lattice;
  }
}

RenderReport render_frame(const ImageView& image, const Scene& scene, const RenderOptions& options,
                          int threads, LayerSetups& kept, DeviceCache& devices) {
  FrameWork work(image, scene, options, threads, kept, devices);
  work.advance(endless);
  return work.report();
}

}  // namespace pellucid
