// SPDX-License-Identifier: Apache-2.0
#include "render_tile.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "pellucid/render/pixel.h"
#include "projection/projected_tracer.h"
#include "tiles.h"

namespace pellucid {
namespace {

/// Returns the mean of a pixel's rays.
RayResult mean_of(const RayResult* rays, int count) {
  PixelMean mean;
  for (int n = 0; n < count; ++n) mean.add(rays[n]);
  return mean.mean();
}

struct PixelPlace {
  int column, row;
};

/// Returns the pixels of a tile, 4 × 4 after 4 × 4, so that those of a packet lie together.
std::vector<PixelPlace> places_of(const Tile& tile) {
  constexpr int group = 4;
  std::vector<PixelPlace> places;
  places.reserve(pixel_count(tile));
  for (int top = 0; top < tile.rows; top += group) {
    for (int left = 0; left < tile.columns; left += group) {
      for (int j = top; j < std::min(top + group, tile.rows); ++j) {
        for (int i = left; i < std::min(left + group, tile.columns); ++i) {
          places.push_back({tile.column + i * tile.stride, tile.row + j * tile.stride});
        }
      }
    }
  }
  return places;
}

/// Composites a pixel over the backdrop, whose depth the pixel has if most of its opacity is there.
void put_over(const Image& backdrop, std::size_t index, RayResult& pixel) {
  const std::array<float, 4>& behind = backdrop.pixels[index];
  const double transparency = 1 - pixel.opacity;
  const double own = pixel.opacity;
  pixel.radiance +=
      transparency * Rgb<double>{double{behind[0]}, double{behind[1]}, double{behind[2]}};
  pixel.opacity += transparency * double{behind[3]};
  if (!(own > 0.5 * pixel.opacity) || std::isinf(pixel.half_opacity_depth)) {
    pixel.half_opacity_depth = double{backdrop.depth[index]};
  }
}

/// Traces the rays; so few at once that the threads can stop soon. `values`, unless null, receives
/// what the projected layer has along each.
std::vector<RayResult> trace(const Frame& frame, const std::vector<RayPart>& rays,
                             const TraceOptions& options, const TileTask& task,
                             std::vector<double>* values) {
  std::vector<RayResult> results;
  for (std::size_t first = 0; first < rays.size() && !task.stop.stop_requested();) {
    const std::size_t left = rays.size() - first;
    const std::size_t count =
        task.stop.stop_possible() ? std::min(task.speed->rays_at_once(), left) : left;
    const auto start = std::chrono::steady_clock::now();
    const auto begin = rays.begin() + static_cast<std::ptrdiff_t>(first);
    const std::vector<RayPart> some(begin, begin + static_cast<std::ptrdiff_t>(count));
    std::vector<double> own;
    const std::vector<RayResult> found = values != nullptr
                                             ? frame.projected->trace(some, options, &own)
                                             : frame.tracer->trace(some, options);
    results.insert(results.end(), found.begin(), found.end());
    if (values != nullptr) values->insert(values->end(), own.begin(), own.end());
    task.speed->tell(count, std::chrono::steady_clock::now() - start);
    first += count;
  }
  return results;
}

/// Returns the result of a ray that misses the region, as do its neighbors.
RayResult nothing_of_region() {
  RayResult nothing = missed_ray_result();
  nothing.neighbor_deviation = 0;
  nothing.longest_step = std::numeric_limits<float>::infinity();
  return nothing;
}

}  // namespace

Interval<double> range_of_rays(const Scene& scene, std::size_t pixel) {
  if (!scene.backdrop) return RayPart{}.range;
  return {0, double{scene.backdrop->depth[pixel]}};
}

std::vector<RayResult> trace_region(const Frame& frame, const std::vector<RayPart>& rays,
                                    const std::function<double(std::size_t)>& allowance_of,
                                    double traced_tolerance_fraction, const TileTask& task) {
  struct Group {
    double allowance;
    std::vector<RayPart> rays{};
    std::vector<std::size_t> of{};
  };
  const RayRegion& region = *frame.region;
  std::vector<Group> groups;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Interval<double> own = region.range(rays[i].ray);
    const Interval<double> range{std::max(own.begin, rays[i].range.begin),
                                 std::min(own.end, rays[i].range.end)};
    if (!(range.begin < range.end)) continue;
    const double allowance = allowance_of(i);
    auto group = std::ranges::find(groups, allowance, &Group::allowance);
    if (group == groups.end()) group = groups.insert(group, {allowance});
    group->rays.push_back({rays[i].ray, range});
    group->of.push_back(i);
  }
  std::vector<RayResult> results(rays.size(), nothing_of_region());
  for (const Group& group : groups) {
    const std::vector<RayResult> found = trace(
        frame, group.rays, {group.allowance, traced_tolerance_fraction, task.stop}, task, nullptr);
    for (std::size_t i = 0; i < found.size(); ++i) results[group.of[i]] = found[i];
  }
  return results;
}

std::size_t render_tile(const Frame& frame, const Tile& tile, const TileTask& task,
                        const ImageView& image, RenderReport& report) {
  const int level = task.level;
  PixelInterpolator* const between = task.between;
  const int samples = frame.scene.samples, rays_of_pixel = samples * samples;
  const auto finish = [&](const PixelPlace& place, const RayResult& result) {
    store_pixel(frame, result, image.index(place.column, place.row), image, report);
    if (level > 1) between->keep(place.column, place.row, result);
  };
  std::vector<PixelPlace> places = places_of(tile);
  if (between != nullptr) {
    std::erase_if(
        places, [&](const PixelPlace& place) { return between->is_done(place.column, place.row); });
  }
  const std::size_t not_final_before = places.size();
  if (frame.region) {
    std::erase_if(places, [&](const PixelPlace& place) {
      if (frame.seen.contains(place.column, place.row)) return false;
      finish(place, nothing_of_region());
      return true;
    });
  }
  if (between != nullptr && level < between->stride()) {
    std::erase_if(places, [&](const PixelPlace& place) {
      RayResult result;
      if (!between->find(place.column, place.row, level, result)) return false;
      finish(place, result);
      ++report.pixels_interpolated;
      return true;
    });
  }
  std::vector<RayPart> rays;
  rays.reserve(places.size() * static_cast<std::size_t>(rays_of_pixel));
  for (const PixelPlace& place : places) {
    const Interval<double> range = range_of_rays(frame.scene, image.index(place.column, place.row));
    if (samples == 1) {
      rays.push_back({frame.camera.ray(place.column, place.row), range});
    } else {
      for (int n = 0; n < rays_of_pixel; ++n) {
        rays.push_back({frame.camera.ray(place.column, place.row, n, samples), range});
      }
    }
  }
  std::vector<double> values;  // of pixels with one ray
  const double traced_tolerance_fraction =
      between != nullptr ? between->traced_tolerance_fraction(level) : 1;
  const auto allowance = [&](std::size_t ray) {
    const double most = frame.region->allowance ? frame.region->allowance(rays[ray].ray) : 1;
    return between != nullptr ? std::min(most, 1.0) : most;
  };
  const std::vector<RayResult> results =
      frame.region ? trace_region(frame, rays, allowance, traced_tolerance_fraction, task)
                   : trace(frame, rays, {1, traced_tolerance_fraction, task.stop}, task,
                           image.values != nullptr ? &values : nullptr);
  if (task.stop.stop_requested()) return 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    image.values[image.index(places[i].column, places[i].row)] = static_cast<float>(values[i]);
  }
  report.rays += rays.size();
  const RayResult* of_pixel = results.data();
  for (const PixelPlace& place : places) {
    RayResult pixel = mean_of(of_pixel, rays_of_pixel);
    if (frame.scene.backdrop && !frame.region) {
      put_over(*frame.scene.backdrop, image.index(place.column, place.row), pixel);
    }
    finish(place, pixel);
    add_work(report, pixel);
    of_pixel += rays_of_pixel;
  }
  return not_final_before;
}

}  // namespace pellucid
