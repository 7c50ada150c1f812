// SPDX-License-Identifier: Apache-2.0
#include "probe.h"

#include <cmath>
#include <utility>

#include "histograms.h"
#include "layer_values.h"

namespace pellucid::view {

namespace {

struct Looked {
  std::vector<std::pair<std::string, double>> values;
  double extinction = 0;
};

Looked look_at(const Layer& layer, const Vec3<double>& world) {
  const LayerValues layer_values(layer);
  const std::vector<double> values = layer_values.at(world);
  Looked looked;
  const auto absorb = [&](const auto& function) {
    if constexpr (requires { function.evaluate(values.data()); }) {
      looked.extinction = function.evaluate(values.data()).extinction;
    } else {
      looked.extinction = function.evaluate(values.front()).extinction;
    }
  };
  if (const auto* labels = std::get_if<LabelContent>(&layer.content)) {
    const std::optional<std::int32_t> label = layer_values.label_at(world);
    if (!label) return looked;
    looked.values.emplace_back("label", *label);
    for (const LabelStyle& style : labels->table->styles()) {
      if (*label == style.label) looked.extinction = style.extinction;
    }
    return looked;
  }
  if (values.empty()) return looked;
  const std::vector<std::string> names = channel_names_of(layer);
  for (std::size_t i = 0; i < values.size(); ++i) looked.values.emplace_back(names[i], values[i]);
  if (const auto* volume = std::get_if<VolumeContent>(&layer.content)) {
    absorb(volume->transfer_function->view<double>());
  } else if (const auto* channels = std::get_if<ChannelsContent>(&layer.content)) {
    absorb(*channels->transfer_function);
  } else if (const auto* mesh = std::get_if<MeshContent>(&layer.content)) {
    if (mesh->univariate() != nullptr) absorb(mesh->univariate()->view<double>());
    if (mesh->multivariate() != nullptr) absorb(*mesh->multivariate());
  }
  return looked;
}

/// Returns the scene with a picture of one pixel, whose ray passes through the position.
Scene scene_of_ray(const Scene& scene, const Ray<double>& ray) {
  Scene one = scene;
  one.size = {1, 1};
  one.samples = 1;
  one.backdrop.reset();
  const double distance = length(scene.camera.focal_point - scene.camera.position);
  one.camera.position = ray.origin;
  one.camera.focal_point = ray.origin + ray.direction * distance;
  return one;
}

}  // namespace

ProbeResult probe(Renderer& renderer, const Scene& scene, const Probe& at) {
  const CameraFrame<double> frame = make_camera_frame(scene.camera, scene.size);
  const Ray<double> ray = frame.ray_through(at.x * scene.size.width, at.y * scene.size.height);
  RenderOptions options;
  options.outputs.depth = true;
  const Image image = renderer.render(scene_of_ray(scene, ray), options).image;
  ProbeResult result;
  result.opacity = static_cast<double>(image.pixels.front()[3]);
  result.optical_depth = -std::log1p(-std::fmin(result.opacity, 1));
  const double depth = static_cast<double>(image.depth.front());
  if (!std::isfinite(depth)) return result;
  result.position = ray.origin + ray.direction * depth;
  double most = 0;
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    if (!scene.layers[i].visible) continue;
    const Looked looked = look_at(scene.layers[i], *result.position);
    for (const auto& [channel, value] : looked.values) result.values.push_back({i, channel, value});
    if (looked.extinction > most) {
      most = looked.extinction;
      result.layer = i;
    }
  }
  return result;
}

Json probe_json(const ProbeResult& result, const Probe& at) {
  Json json{{"type", "probe"}, {"x", at.x}, {"y", at.y}, {"opacity", result.opacity}};
  if (at.picks) json["picks"] = true;
  json["optical_depth"] = std::isfinite(result.optical_depth) ? Json(result.optical_depth) : Json();
  if (result.position) {
    json["position"] = {result.position->x, result.position->y, result.position->z};
  }
  json["values"] = Json::array();
  for (const ProbeResult::Value& value : result.values) {
    json["values"].push_back(
        {{"layer", value.layer}, {"channel", value.channel}, {"value", value.value}});
  }
  if (result.layer) json["layer"] = *result.layer;
  return json;
}

}  // namespace pellucid::view
