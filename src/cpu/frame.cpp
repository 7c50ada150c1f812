// SPDX-License-Identifier: Apache-2.0
#include "frame.h"

#include <algorithm>
#include <optional>

namespace pellucid {
namespace {

/// The largest component of what lies behind the data.
double brightest(const std::optional<Rgb<double>>& background) {
  return background ? std::max({background->r, background->g, background->b}) : 0;
}

/// Rounding a pixel to binary32 costs at most half a unit in its last place.
double storage_error(double value) {
  return std::max(value, 1.0) * 0x1p-24;
}

std::vector<Layer> visible_layers(const Scene& scene) {
  std::vector<Layer> layers;
  for (const Layer& layer : scene.layers) {
    if (layer.visible) layers.push_back(moved_into_place(layer));
  }
  return layers;
}

/// A tracer of one kind of data; null where it takes the general path.
std::unique_ptr<const RayTracer> make_fast_tracer(const TracerTask& task) {
  const Layer& layer = task.layer;
  if (const auto* volume = std::get_if<VolumeContent>(&layer.content)) {
    return volume->mask ? nullptr : make_univariate_tracer(task);
  }
  if (!layer.clips.empty() || !task.scene.clips.empty()) return nullptr;
  if (std::holds_alternative<MeshContent>(layer.content)) return make_mesh_tracer(task);
  if (std::holds_alternative<ChannelsContent>(layer.content)) return make_multivariate_tracer(task);
  return nullptr;
}

std::unique_ptr<const RayTracer> make_tracer(const TracerTask& task,
                                             const std::vector<Layer>& layers) {
  if (layers.size() == 1) {
    if (auto tracer = make_fast_tracer(task)) return tracer;
  }
  return make_layered_tracer(task, layers);
}

}  // namespace

Frame::Frame(const Scene& described, const RenderOptions& options, int threads)
    : scene(described),
      layers(visible_layers(described)),
      camera(make_camera_frame(described.camera, described.size)),
      tolerance(0),
      reserved(0) {
  for (const Layer& layer : layers) {
    // Beside other layers, whose colors differ, the bound of a single function doubles: the change
    // of the extinction is seen in its own color, not in that of the mixture.
    reserved +=
        (layers.size() > 1 ? 2 : 1) * approximation_error(layer, brightest(described.background));
  }
  const Integration& integration = scene.integration;
  static const Layer nothing;
  TracerTask task{scene, layers.empty() ? nothing : layers.front(), options, {}, threads};
  task.wanted.tolerance =
      std::max(integration.tolerance - reserved - storage_error(largest_color(scene)),
               0.25 * integration.tolerance);
  tolerance = task.wanted.tolerance;
  task.wanted.grade = integration.grade;
  task.wanted.precision = integration.precision;
  task.wanted.largest_color = std::max(largest_color(scene), brightest(scene.background));
  tracer = make_tracer(task, layers);
}

}  // namespace pellucid
