// SPDX-License-Identifier: Apache-2.0
#include "device_frame.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <variant>
#include <vector>

#include "device_layer.h"
#include "frame/progress.h"
#include "frame/render_tile.h"
#include "frame/tiles.h"
#include "layers/layer_setup.h"
#include "pellucid/cpu/threads.h"
#include "threads.h"

namespace pellucid {
namespace {

/// Rays of a launch if somebody may want to stop the frame, or to see how far it is.
constexpr std::int64_t rays_of_launch = 1 << 18;

/// Returns the frame's pixels as few tiles, level after level, each a launch.
std::vector<Tile> make_launches(const Scene& scene, const RenderOptions& options) {
  const bool whole =
      !options.monitor.stop.stop_possible() && !options.monitor.progress && !options.monitor.tile;
  const std::int64_t rays = std::int64_t{scene.samples} * scene.samples;
  std::vector<Tile> launches;
  const auto add = [&](int column, int row, int stride, int level) {
    if (column >= scene.size.width || row >= scene.size.height) return;
    const int columns = (scene.size.width - column + stride - 1) / stride;
    const int rows = (scene.size.height - row + stride - 1) / stride;
    const std::int64_t at_once =
        whole ? rows : std::max<std::int64_t>(rays_of_launch / (rays * columns), 1);
    for (std::int64_t first = 0; first < rows; first += at_once) {
      const auto begin = static_cast<int>(first);
      launches.push_back({column, row + begin * stride, columns,
                          static_cast<int>(std::min<std::int64_t>(at_once, rows - first)), stride,
                          level});
    }
  };
  for (int level = options.monitor.preview; level >= 0; --level) {
    const int edge = 1 << level;
    if (level == options.monitor.preview) {
      add(0, 0, edge, level);
    } else {
      add(edge, 0, 2 * edge, level);
      add(0, edge, 2 * edge, level);
      add(edge, edge, 2 * edge, level);
    }
  }
  return launches;
}

/// A frame on its way.
class DeviceFrame {
 public:
  DeviceFrame(const Frame& frame, const RenderOptions& options, CachedDevice& device,
              const ImageView& image, RenderReport& report)
      : frame_(frame),
        options_(options),
        device_(device),
        view_(image),
        report_(report),
        parallel_(parallel_for(report.threads)),
        scene_(resident(frame)),
        task_(device.prepare(frame.scene.size, view_.depth != nullptr, view_.error != nullptr)) {}

  void render() {
    const std::vector<Tile> launches = make_launches(frame_.scene, options_);
    Progress progress(options_, view_, launches);
    for (const Tile& tile : launches) {
      if (options_.monitor.stop.stop_requested()) throw Cancelled();
      follow(tile);
      progress.finish_tile(tile, pixel_count(tile));
      if (progress.cancelled()) throw Cancelled();
    }
    progress.finish();
    if (progress.cancelled()) throw Cancelled();
  }

 private:
  /// Returns the scene in the memory of the device.
  DeviceScene resident(const Frame& frame) const {
    DeviceScene scene = frame.only_layer->device(parallel_).scene();
    scene.camera = frame.camera;
    scene.samples = frame.scene.samples;
    scene.limits = {frame.reserved, frame.largest_color, frame.scene.integration.tolerance};
    scene.with_depth = options_.outputs.depth;
    if (frame.scene.backdrop) {
      scene.backdrop_depth = frame.scene.backdrop->depth.data();
      scene.backdrop_color = frame.scene.backdrop->pixels.data()->data();
    }
    // Both keep what the scene points to.
    using Owners = std::pair<std::shared_ptr<const LayerSetup>, std::shared_ptr<const Image>>;
    return device_.arrays().resident(
        scene, std::make_shared<const Owners>(frame.only_layer, frame.scene.backdrop));
  }

  void follow(const Tile& tile) {
    task_.pixels = {tile.column, tile.row, tile.columns, tile.rows, tile.stride};
    device_.backend().trace(scene_, task_, parallel_);
    DeviceCounts counts;
    device_.backend().download(&counts, task_.counts, sizeof(counts));
    const int last_row = tile.row + (tile.rows - 1) * tile.stride;
    fetch(view_.index(0, tile.row), view_.index(0, last_row + 1));
    count(counts, pixel_count(tile));
    if (counts.left > 0) follow_left(counts.left);
  }

  /// Copies pixels from the device's image.
  void fetch(std::size_t first, std::size_t last) {
    const auto copy = [&]<class T>(T* to, const T* from, std::size_t numbers) {
      if (to == nullptr) return;
      device_.backend().download(to + numbers * first, from + numbers * first,
                                 numbers * (last - first) * sizeof(T));
    };
    copy(view_.pixels->data(), task_.image.color, 4);
    copy(view_.depth, task_.image.depth, 1);
    copy(view_.error, task_.image.error, 1);
    copy(view_.proved, task_.image.proved, 1);
  }
  /// Copies a pixel to the device's image, which is complete for those who look at it there.
  void put_back(std::size_t pixel) {
    const auto copy = [&]<class T>(T* to, const T* from, std::size_t numbers) {
      if (to == nullptr) return;
      device_.backend().upload(to + numbers * pixel, from + numbers * pixel, numbers * sizeof(T));
    };
    copy(task_.image.color, view_.pixels->data(), 4);
    copy(task_.image.depth, view_.depth, 1);
    copy(task_.image.error, view_.error, 1);
    copy(task_.image.proved, view_.proved, 1);
  }

  void count(const DeviceCounts& counts, std::size_t pixels) {
    const auto rays = static_cast<std::uint64_t>(frame_.scene.samples) *
                      static_cast<std::uint64_t>(frame_.scene.samples);
    report_.rays += rays * (pixels - counts.left);
    report_.cells += counts.cells;
    report_.evaluations += counts.evaluations;
    report_.spans +=
        RuleCounts{counts.skipped, counts.constant, counts.strides,        counts.lines,
                   counts.closed,  counts.panels,   counts.cells_in_double};
    report_.pixels_in_double += counts.in_double;
    report_.pixels_left += counts.left;
    if (frame_.scene.integration.method != Method::exact) return;
    report_.largest_error =
        std::max(report_.largest_error, std::bit_cast<double>(counts.largest_error));
    report_.pixels_proved += counts.proved;
    report_.pixels_over_tolerance += counts.over;
  }

  /// Follows the rays of the pixels that the device left.
  void follow_left(std::size_t count) {
    std::vector<std::uint32_t> pixels(count);
    device_.backend().download(pixels.data(), task_.left.pixel, count * sizeof(pixels[0]));
    std::ranges::sort(pixels);
    std::mutex mutex;
    TileSpeed speed;
    const auto width = static_cast<std::uint32_t>(frame_.scene.size.width);
    parallel_for_ordered(count, report_.threads, [&](std::size_t i) {
      const Tile pixel{static_cast<int>(pixels[i] % width), static_cast<int>(pixels[i] / width), 1,
                       1};
      RenderReport part;
      render_tile(frame_, pixel, {1, nullptr, options_.monitor.stop, &speed}, view_, part);
      if (options_.monitor.stop.stop_requested()) return false;
      const std::lock_guard lock(mutex);
      add(report_, part);
      return true;
    });
    if (options_.monitor.stop.stop_requested()) throw Cancelled();
    for (const std::uint32_t pixel : pixels) put_back(pixel);
  }

  const Frame& frame_;
  const RenderOptions& options_;
  CachedDevice& device_;
  const ImageView view_;
  RenderReport& report_;
  const ParallelFor parallel_;
  const DeviceScene scene_;
  DeviceTask task_;
};

}  // namespace

std::string reason_for_cpu(const Frame& frame, const RenderOptions& options) {
  if (options.outputs.values || frame.projected != nullptr) return "projections";
  if (frame.only_layer == nullptr) return "several layers or clips";
  const Layer& layer = frame.only_layer->layer();
  if (frame.scene.backdrop && !std::holds_alternative<VolumeContent>(layer.content)) {
    return "a backdrop behind other data than one volume";
  }
  return DeviceLayer::cannot_follow(layer, frame.scene.integration);
}

void render_on_device(const Frame& frame, const RenderOptions& options, CachedDevice& device,
                      const ImageView& image, RenderReport& report) {
  const std::lock_guard lock(device.in_use);
  DeviceFrame(frame, options, device, image, report).render();
  device.arrays().end_frame();
  report.device = "rendered by " + device.backend().name();
  if (report.pixels_left > 0) {
    report.device += "; it left " + std::to_string(report.pixels_left) + " of " +
                     std::to_string(report.pixels) + " pixels to the CPU";
  }
}

}  // namespace pellucid
