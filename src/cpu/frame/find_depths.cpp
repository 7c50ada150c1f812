// SPDX-License-Identifier: Apache-2.0
#include "pellucid/cpu/internal/find_depths.h"

#include <algorithm>
#include <limits>

#include "frame.h"
#include "threads.h"

namespace pellucid {
namespace {

/// Returns the part of a pixel's ray that is followed.
RayPart part_of(const Frame& frame, const DepthRequest& request) {
  RayPart part{frame.camera.ray(request.column, request.row)};
  if (frame.scene.backdrop) {
    const auto width = static_cast<std::size_t>(frame.scene.size.width);
    const std::size_t pixel =
        static_cast<std::size_t>(request.row) * width + static_cast<std::size_t>(request.column);
    part.range.end = double{frame.scene.backdrop->depth[pixel]};
  }
  if (frame.region) {
    const Interval<double> own = frame.region->range(part.ray);
    part.range = {std::max(own.begin, part.range.begin), std::min(own.end, part.range.end)};
  }
  return part;
}

/// Returns the scene without light, on which no optical depth depends. A shading stays beside
/// gradient opacity.
Scene without_light(Scene scene) {
  for (Layer& layer : scene.layers) {
    if (!layer.gradient_opacity) layer.shading.reset();
  }
  return scene;
}

}  // namespace

std::vector<double> find_depths(const Scene& scene, const RenderOptions& options,
                                const std::vector<DepthRequest>& requests) {
  check_data(scene);
  check_integration(scene);
  const int threads =
      options.machine.threads > 0 ? options.machine.threads : default_thread_count();
  LayerSetups setups;
  const Scene unlit = without_light(scene);
  const Frame frame(unlit, options, threads, setups);
  std::vector<double> found(requests.size(), std::numeric_limits<double>::infinity());
  constexpr std::size_t at_once = 64;
  parallel_for_ordered((requests.size() + at_once - 1) / at_once, threads, [&](std::size_t group) {
    std::vector<RayPart> parts;
    std::vector<double> depths;
    std::vector<std::size_t> of;
    const std::size_t end = std::min((group + 1) * at_once, requests.size());
    for (std::size_t i = group * at_once; i < end; ++i) {
      const RayPart part = part_of(frame, requests[i]);
      if (!(part.range.begin < part.range.end)) continue;
      parts.push_back(part);
      depths.push_back(requests[i].optical_depth);
      of.push_back(i);
    }
    const std::vector<double> positions = frame.tracer->find_depths(parts, depths);
    for (std::size_t i = 0; i < of.size(); ++i) found[of[i]] = positions[i];
    return !options.monitor.stop.stop_requested();
  });
  if (options.monitor.stop.stop_requested()) throw Cancelled();
  return found;
}

}  // namespace pellucid
