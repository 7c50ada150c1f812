// SPDX-License-Identifier: Apache-2.0
#include "render_frame.h"

#include <algorithm>
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

/// A part of a pixel is composited ray by ray, and a projection is no composite.
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

void render_tiles(const Frame& frame, const RenderOptions& options, const ImageView& image,
                  RenderReport& report) {
  const std::vector<Tile> tiles = make_tiles(frame.scene.size, options.monitor.preview);
  std::mutex report_mutex;
  Progress progress(options, image, tiles);
  TileSpeed speed;
  const std::unique_ptr<PixelInterpolator> between = PixelInterpolator::make(frame, image);
  const auto render_level = [&](std::span<const Tile> some, int level, const auto& finish) {
    parallel_for_ordered(some.size(), report.threads, [&](std::size_t i) {
      RenderReport part;
      const std::size_t pixels = render_tile(
          frame, some[i], {level, between.get(), options.monitor.stop, &speed}, image, part);
      if (options.monitor.stop.stop_requested()) return false;
      {
        const std::lock_guard lock(report_mutex);
        add(report, part);
      }
      finish(some[i], pixels);
      return !progress.cancelled();
    });
    if (options.monitor.stop.stop_requested() || progress.cancelled()) throw Cancelled();
  };
  const auto finish_tile = [&](const Tile& tile, std::size_t pixels) {
    progress.finish_tile(tile, pixels);
  };
  std::size_t next_tile = 0;
  if (between) {
    for (int level = between->stride(); level > 1 && between->goes_on(); level /= 2) {
      const std::span<const Tile> of_preview = tiles_of(tiles, next_tile, level);
      if (1 << options.monitor.preview >= level) {
        render_level(of_preview, level, finish_tile);
        next_tile += of_preview.size();
      } else {
        render_level(make_lattice(frame.scene.size, level), level,
                     [&](const Tile&, std::size_t pixels) { progress.finish_pixels(pixels); });
      }
      between->finish_level(level, report.threads);
    }
  }
  render_level(tiles_of(tiles, next_tile, 1), 1, finish_tile);
  progress.finish();
  if (progress.cancelled()) throw Cancelled();
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

RenderReport render_frame(const ImageView& image, const Scene& scene, const RenderOptions& options,
                          int threads, LayerSetups& kept, DeviceCache& devices) {
  RenderReport local;
  local.threads = threads;
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  const std::shared_ptr<CachedDevice> device =
      options.machine.device == Device::cpu ? nullptr : devices.find(options.machine.device);
  const Frame frame(scene, options, threads, kept);
  local.pixels = static_cast<std::uint64_t>(image.width) * static_cast<std::uint64_t>(image.height);
  local.setup_seconds = seconds();
  local.sampled_in_float = scene.integration.method != Method::exact && frame.only_layer &&
                           frame.only_layer->fast() != nullptr;
  const std::string reason = device ? reason_for_cpu(frame, options) : "";
  if (device && reason.empty()) {
    render_on_device(frame, options, *device, image, local);
  } else {
    render_tiles(frame, options, image, local);
    if (device) local.device = "rendered by the CPU: devices cannot do " + reason + " yet";
  }
  local.seconds = seconds();
  return local;
}

}  // namespace pellucid
