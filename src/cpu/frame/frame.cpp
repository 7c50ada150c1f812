// SPDX-License-Identifier: Apache-2.0
#include "frame.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "layers/scene_tracer.h"
#include "projection/projected_tracer.h"
#include "threads.h"

namespace pellucid {
namespace {

/// Returns what rounding a pixel to binary32 costs at most: half a unit in its last place.
double storage_error(double value) {
  return std::max(value, 1.0) * 0x1p-24;
}

std::vector<const Layer*> visible_layers(const Scene& scene, bool projected) {
  std::vector<const Layer*> layers;
  for (const Layer& layer : scene.layers) {
    if (layer.visible && layer.projection.has_value() == projected) layers.push_back(&layer);
  }
  return layers;
}

/// Returns the length of a ray that no data are longer than.
double reach(const std::vector<const Layer*>& layers) {
  double longest = 0;
  for (const Layer* layer : layers) {
    const std::array<Vec3<double>, 8> corners = world_corners(*layer);
    for (std::size_t i = 0; i < 4; ++i) {
      longest = std::max(longest, length(corners[7 - i] - corners[i]));
    }
  }
  return longest;
}

/// Returns the extinction that each layer may leave out all along a ray.
double negligible_extinction(const std::vector<const Layer*>& layers, const RayTolerance& wanted) {
  return ray_left_out_share * wanted.tolerance /
         (std::max(reach(layers), std::numeric_limits<double>::min()) *
          std::max(wanted.largest_color, 1.0) * std::max(static_cast<double>(layers.size()), 1.0));
}

/// Returns the pixels that may see a box, given by its corners.
PixelBox pixels_of(const CameraFrame<double>& camera, const std::array<Vec3<double>, 8>& corners) {
  const PixelBox all{0, camera.width, 0, camera.height};
  const double right = dot(camera.right, camera.right), up = dot(camera.up, camera.up);
  double left = camera.width, last_column = 0, top = camera.height, last_row = 0, farthest = 0;
  for (const Vec3<double>& corner : corners) {
    farthest = std::max(farthest, length(corner - camera.position));
  }
  for (const Vec3<double>& corner : corners) {
    const Vec3<double> to = corner - camera.position;
    const double depth = camera.perspective ? dot(to, camera.forward) : 1;
    // From inside, or nearly so, all pixels may.
    if (!(depth > 1e-3 * (camera.perspective ? farthest : 1))) return all;
    const double x = (dot(to, camera.right) / (right * depth) + 1) * 0.5 * camera.width;
    const double y = (1 - dot(to, camera.up) / (up * depth)) * 0.5 * camera.height;
    left = std::min(left, x);
    last_column = std::max(last_column, x);
    top = std::min(top, y);
    last_row = std::max(last_row, y);
  }
  // A pixel more on each side: rays go through their centers.
  const auto before = [](double at) { return static_cast<int>(std::max(std::floor(at) - 1, 0.0)); };
  const auto behind = [](double at, int count) {
    return static_cast<int>(std::clamp(std::ceil(at) + 1, 0.0, 1.0 * count));
  };
  return {before(left), behind(last_column, camera.width), before(top),
          behind(last_row, camera.height)};
}

}  // namespace

Frame::Frame(const Scene& described, const RenderOptions& options, int threads, LayerSetups& kept)
    : scene(described),
      region(options.outputs.region),
      camera(make_camera_frame(described.camera, described.size)),
      tolerance(0),
      reserved(options.outputs.region ? 0 : approximation_error(described)),
      largest_color(pellucid::largest_color(described)) {
  seen = {0, camera.width, 0, camera.height};
  if (region && region->corners) seen = pixels_of(camera, *region->corners);
  const double behind = brightest_behind(scene);
  if (scene.backdrop) largest_color = std::max(largest_color, behind);
  const std::vector<const Layer*> layers = visible_layers(scene, false);
  const std::vector<const Layer*> projections = visible_layers(scene, true);
  const Integration& integration = scene.integration;
  RayTolerance wanted;
  wanted.tolerance = std::max(integration.tolerance - reserved - storage_error(largest_color),
                              0.25 * integration.tolerance);
  // What is left out of a sampled picture must not be seen beside its own errors.
  if (integration.method != Method::exact) wanted.tolerance = smallest_tolerance;
  tolerance = wanted.tolerance;
  wanted.grade = integration.grade;
  wanted.precision = integration.precision;
  wanted.largest_color = std::max(largest_color, behind);
  // Where nothing is lit, other lights are no other setting.
  const bool lit =
      std::ranges::any_of(layers, [](const Layer* layer) { return layer->shading.has_value(); });
  const LayerSetting setting(integration, wanted, negligible_extinction(layers, wanted),
                             lit ? scene.lights : std::vector<Light>{}, options);
  std::vector<ClippedLayer> clipped;
  clipped.reserve(layers.size());
  for (const Layer* layer : layers) {
    clipped.push_back({kept.find(*layer, setting, threads), clips_of(*layer, scene.clips)});
  }
  if (clipped.size() == 1 && projections.empty() && clipped[0].clips.empty()) {
    only_layer = clipped[0].setup;
  }
  kept.keep_only(scene);
  if (!layers.empty() || projections.empty()) {
    tracer = make_scene_tracer(std::move(clipped), scene.lights, wanted, options.outputs.depth);
  }
  if (projections.empty()) return;
  std::vector<Layer> in_place;
  in_place.reserve(projections.size());
  for (const Layer* layer : projections) in_place.push_back(moved_into_place(*layer));
  auto projecting =
      std::make_unique<const ProjectedTracer>(std::move(in_place), std::move(tracer), scene.clips,
                                              wanted.largest_color, parallel_for(threads));
  projected = projecting.get();
  tracer = std::move(projecting);
}

}  // namespace pellucid
