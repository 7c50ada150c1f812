// SPDX-License-Identifier: Apache-2.0
#include "pellucid/cpu/internal/projected_rays.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "layers/clip_intervals.h"
#include "pellucid/scene/error.h"
#include "projection/layer_projector.h"
#include "projection/shown_value.h"
#include "threads.h"

namespace pellucid {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

bool is_extreme(LayerProjection projection) {
  return projection <= LayerProjection::minimum;
}

/// Returns the half-spaces of a region as clips, which cut neighboring regions at the same
/// positions.
std::vector<Clip> clips_of_region(const RayRegion& region) {
  std::vector<Clip> clips;
  for (const RayRegion::HalfSpace& half : region.half_spaces) {
    const double squared = dot(half.normal, half.normal);
    const Vec3<double> normal = half.above ? half.normal : -half.normal;
    clips.push_back({ClipPlane{half.normal * (half.offset / squared), normal}});
  }
  return clips;
}

ProjectedRays empty_rays(LayerProjection projection, std::size_t count) {
  const double nothing = projection == LayerProjection::maximum   ? -infinity
                         : projection == LayerProjection::minimum ? infinity
                                                                  : 0.0;
  ProjectedRays rays;
  rays.projection = projection;
  rays.value.assign(count, nothing);
  rays.lower = rays.upper = rays.value;
  rays.data.assign(count, 0);
  rays.unknown = rays.data;
  if (projection == LayerProjection::mean) rays.length = rays.length_error = rays.data;
  return rays;
}

void store(const RayValue& found, std::size_t ray, ProjectedRays& rays) {
  rays.unknown[ray] = found.is_unknown ? 1 : 0;
  if (found.is_unknown && is_extreme(rays.projection)) {
    // It may be there or not: only one of the bounds knows of it.
    (rays.projection == LayerProjection::maximum ? rays.upper : rays.lower)[ray] = found.upper;
    return;
  }
  if (!found.has_data) return;
  rays.data[ray] = 1;
  rays.value[ray] = found.value;
  rays.lower[ray] = found.lower;
  rays.upper[ray] = found.upper;
  if (rays.length.empty()) return;
  rays.length[ray] = found.length;
  rays.length_error[ray] = found.length_error;
}

}  // namespace

RayValue ProjectedRays::at(std::size_t ray) const {
  RayValue result;
  result.has_data = data[ray] > 0;
  result.is_unknown = unknown[ray] > 0 && !(result.has_data && is_extreme(projection));
  if (!result.has_data) {
    if (projection == LayerProjection::sum) result.value = 0;
    return result;
  }
  result.value = value[ray];
  result.lower = std::min(lower[ray], result.value);
  result.upper = std::max(upper[ray], result.value);
  if (projection != LayerProjection::mean) return result;
  const double sum = value[ray], off_length = length_error[ray];
  const double off_sum = std::max(upper[ray] - sum, sum - lower[ray]);
  if (!(length[ray] > 2 * off_length)) {
    result.is_unknown = true;
    return result;
  }
  result.value = sum / length[ray];
  const double off = (off_sum + std::abs(result.value) * off_length) / (length[ray] - off_length) +
                     8 * std::numeric_limits<double>::epsilon() * std::abs(result.value);
  result.lower = result.value - off;
  result.upper = result.value + off;
  return result;
}

ProjectedRays project_layer(const Scene& scene, std::size_t index, const RenderOptions& options) {
  check_data(scene);
  if (index >= scene.layers.size() || !scene.layers[index].projection) {
    throw Error("layer " + std::to_string(index + 1) + ": is not projected");
  }
  Layer layer = moved_into_place(scene.layers[index]);
  const LayerProjection projection = *layer.projection;
  // Means of parts are joined by their sums.
  if (projection == LayerProjection::mean) layer.projection = LayerProjection::sum;
  std::vector<Clip> clips = clips_of(layer, scene.clips);
  if (options.outputs.region) {
    for (const Clip& clip : clips_of_region(*options.outputs.region)) clips.push_back(clip);
  }
  const int threads =
      options.machine.threads > 0 ? options.machine.threads : default_thread_count();
  const auto projector = make_layer_projector({layer, std::move(clips), parallel_for(threads)});
  const CameraFrame<double> camera = make_camera_frame(scene.camera, scene.size);
  const auto width = static_cast<std::size_t>(camera.width);
  const auto rows = static_cast<std::size_t>(camera.height);
  ProjectedRays rays = empty_rays(projection, width * rows);
  std::mutex progress_mutex;
  std::size_t done = 0;
  bool cancelled = false;
  parallel_for_ordered(rows, threads, [&](std::size_t row) {
    const auto workspace = projector->workspace();
    for (std::size_t column = 0; column < width; ++column) {
      const std::size_t ray = row * width + column;
      const double end = scene.backdrop ? double{scene.backdrop->depth[ray]} : infinity;
      const Ray<double> from = camera.ray(static_cast<int>(column), static_cast<int>(row));
      store(projector->project(from, end, *workspace), ray, rays);
    }
    const std::lock_guard lock(progress_mutex);
    ++done;
    if (options.monitor.progress && !cancelled) {
      cancelled = !options.monitor.progress(static_cast<double>(done) / static_cast<double>(rows));
    }
    return !cancelled && !options.monitor.stop.stop_requested();
  });
  if (cancelled || options.monitor.stop.stop_requested()) throw Cancelled();
  return rays;
}

struct ProjectionColors::Colors {
  std::vector<Layer> layers;
  std::vector<ValueColors> shown;
  double largest = 1;
};

ProjectionColors::ProjectionColors(const Scene& scene) {
  auto colors = std::make_unique<Colors>();
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    if (!scene.layers[i].visible || !scene.layers[i].projection) continue;
    layers_.push_back(i);
    colors->layers.push_back(scene.layers[i]);
  }
  for (const Layer& layer : colors->layers) colors->shown.emplace_back(function_of(layer));
  colors->largest = std::max({largest_color(scene), brightest_behind(scene), 1.0});
  colors_ = std::move(colors);
}

ProjectionColors::~ProjectionColors() = default;

void ProjectionColors::put_over(const std::vector<RayValue>& values, RayResult& ray) const {
  ShownValue front;
  for (std::size_t i = 0; i < colors_->shown.size(); ++i) {
    front = composite(colors_->shown[i].show(values[i]), front);
  }
  pellucid::put_over(front, colors_->largest, ray);
}

}  // namespace pellucid
