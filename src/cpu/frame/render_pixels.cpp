// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <mutex>
#include <utility>
#include <vector>

#include "frame.h"
#include "pellucid/scene/error.h"
#include "pixel.h"
#include "render_frame.h"
#include "render_tile.h"
#include "threads.h"

namespace pellucid {

RenderResult render_pixels(const Scene& scene, const RenderOptions& options,
                           const std::vector<PixelRequest>& requests, int threads,
                           LayerSetups& kept) {
  check_data(scene);
  check_integration(scene);
  if (!options.outputs.region)
    throw Error("pixels: none is rendered again without a region; give one");
  const Frame frame(scene, options, threads, kept);
  Image image;
  image.width = static_cast<int>(requests.size());
  image.height = 1;
  image.pixels.resize(requests.size());
  image.error.resize(requests.size());
  image.proved.resize(requests.size());
  const ImageView view(image);
  RenderReport all;
  std::mutex mutex;
  std::size_t done = 0;
  std::atomic<bool> cancelled{false};
  TileSpeed speed;
  constexpr std::size_t at_once = 256;
  parallel_for_ordered((requests.size() + at_once - 1) / at_once, threads, [&](std::size_t group) {
    const std::size_t first = group * at_once, end = std::min(first + at_once, requests.size());
    std::vector<RayPart> rays;
    for (std::size_t i = first; i < end; ++i) {
      const PixelRequest& pixel = requests[i];
      const auto index =
          static_cast<std::size_t>(pixel.row) * static_cast<std::size_t>(scene.size.width) +
          static_cast<std::size_t>(pixel.column);
      rays.push_back({frame.camera.ray(pixel.column, pixel.row), range_of_rays(scene, index)});
    }
    const std::vector<RayResult> found =
        trace_region(frame, rays, [&](std::size_t i) { return requests[first + i].allowance; }, 1,
                     {1, nullptr, options.monitor.stop, &speed});
    if (options.monitor.stop.stop_requested()) return false;
    const std::lock_guard lock(mutex);
    all.rays += rays.size();
    for (std::size_t i = 0; i < found.size(); ++i) {
      store_pixel(frame, found[i], first + i, view, all);
      add_work(all, found[i]);
    }
    done += found.size();
    if (!options.monitor.progress) return true;
    const double fraction = static_cast<double>(done) / static_cast<double>(requests.size());
    if (!options.monitor.progress(fraction)) cancelled = true;
    return !cancelled.load();
  });
  if (options.monitor.stop.stop_requested() || cancelled) throw Cancelled();
  return {std::move(image), all};
}

}  // namespace pellucid
