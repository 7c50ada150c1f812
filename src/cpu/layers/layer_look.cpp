// SPDX-License-Identifier: Apache-2.0
#include "layer_look.h"

#include <cmath>
#include <limits>

namespace pellucid {

LayerLook::LayerLook(const Layer& layer)
    : layer_(layer), has_medium_(largest_extinction(layer) > 0) {
  if (layer.shading) {
    const Shading& shading = *layer.shading;
    const double flat = flat_gradient(layer);
    reflection_ = {shading.ambient, shading.diffuse, shading.specular, shading.power, flat * flat};
  }
  if (layer.gradient_opacity) {
    factors_ = layer.gradient_opacity->per_world(voxel_of(layer));
    factor_view_ = factors_->view<double>();
  }
}

std::vector<SlicePosition> slice_positions(const std::vector<Slice>& slices,
                                           const Ray<double>& ray) {
  std::vector<SlicePosition> result;
  for (const Slice& slice : slices) {
    // Scaled, so that products neither overflow nor underflow.
    const Vec3<double> n =
        slice.normal * (1 / std::hypot(slice.normal.x, slice.normal.y, slice.normal.z));
    const auto toward = [&](const auto& of) {
      return static_cast<long double>(n.x) * of.x + static_cast<long double>(n.y) * of.y +
             static_cast<long double>(n.z) * of.z;
    };
    const long double slope = toward(ray.direction);
    const long double t = (toward(slice.point) - toward(ray.origin)) / slope;
    if (!std::isfinite(t) || t < 0) {
      result.push_back({std::numeric_limits<double>::infinity(), 0});
      continue;
    }
    const double sizes = length(slice.point) + length(ray.origin) + static_cast<double>(t);
    result.push_back({static_cast<double>(t),
                      8 * rounding_unit<double> * sizes / static_cast<double>(std::abs(slope))});
  }
  return result;
}

std::vector<LightSource<double>> light_sources(const std::vector<Light>& lights) {
  std::vector<LightSource<double>> result;
  for (const Light& light : lights) {
    LightSource<double> source;
    source.color = light.color;
    if (const auto* directional = std::get_if<DirectionalLight>(&light.kind)) {
      const Vec3<double>& d = directional->direction;
      source.kind = LightSource<double>::Kind::directional;
      source.place = d * (-1 / std::hypot(d.x, d.y, d.z));
    } else if (const auto* point = std::get_if<PointLight>(&light.kind)) {
      source.kind = LightSource<double>::Kind::point;
      source.place = point->position;
    }
    result.push_back(source);
  }
  return result;
}

}  // namespace pellucid
