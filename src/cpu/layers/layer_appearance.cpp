// SPDX-License-Identifier: Apache-2.0
#include "layer_appearance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace pellucid {
namespace {

/// v / |v|, also where squares and inverses would overflow or underflow.
Vec3<double> unit(const Vec3<double>& v) {
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  return normalized(Vec3<double>{v.x / largest, v.y / largest, v.z / largest});
}

/// Returns the largest |value| of a channel if one is negative, else 0.
double largest_if_negative(const Layer& layer, int channel) {
  if (const auto* const own = std::get_if<SourceContent>(&layer.content)) {
    const auto& [name, least, most] =
        own->source->description().variables[static_cast<std::size_t>(channel)];
    return least < 0 ? std::max(-least, most) : 0;
  }
  const auto* const channels = std::get_if<ChannelsContent>(&layer.content);
  const auto& data = channels != nullptr
                         ? (*channels->channels)[channel].volume->statistics()
                         : std::get<MeshContent>(layer.content).mesh->statistics(channel);
  return data.minimum < 0 ? std::max(-data.minimum, data.maximum) : 0;
}

/// The function of v + shift. Of points that come to lie at one place, the first and the last stay.
TransferFunction shifted(const TransferFunction& function, double shift) {
  std::vector<TransferFunction::Point> points;
  for (TransferFunction::Point point : function.points()) {
    point.value += shift;
    const std::size_t count = points.size();
    if (count >= 2 && points[count - 2].value == point.value) points.pop_back();
    points.push_back(point);
  }
  return TransferFunction(std::move(points));
}

}  // namespace

LayerAppearance::LayerAppearance(const Layer& layer)
    : layer_(layer), has_medium_(largest_extinction(layer) > 0) {
  if (layer.shading) {
    const Shading& shading = *layer.shading;
    const auto reflection = [&](double flat) {
      return Reflection<double>{shading.ambient, shading.diffuse, shading.specular, shading.power,
                                flat * flat};
    };
    surface_reflection_ = reflection(flat_gradient_of_surfaces(layer));
    reflection_ = has_medium_ ? reflection(flat_gradient(layer)) : surface_reflection_;
  }
  if (layer.gradient_opacity) {
    factors_ = layer.gradient_opacity->per_world(voxel_of(layer));
    factor_view_ = factors_->view<double>();
  }
  value_factor_ = extinction_factor_of(layer);
  if (value_factor_ != nullptr) {
    // Panels take magnitudes for their errors, which grow with them. Moved up that far, values are
    // no smaller than the largest |value|.
    factor_shift_ = 2 * largest_if_negative(layer, value_factor_->channel);
    factors_ = shifted(value_factor_->function, factor_shift_);
    factor_view_ = factors_->view<double>();
  }
}

std::optional<TransferFunction> isosurface_support(const LayerAppearance& look, int channel,
                                                   double off) {
  std::vector<double> values;
  for (const Isosurface& surface : look.isosurfaces()) {
    if (surface.channel == channel) values.push_back(surface.value);
  }
  if (values.empty()) return std::nullopt;
  std::ranges::sort(values);
  std::vector<TransferFunction::Point> points;
  for (const double value : values) {
    // Far more than what rounding may make of data, and a triangle to be told from nothing.
    const double beside = std::max({off, std::abs(value) * 0x1p-20, 0x1p-120});
    if (points.empty() || points.back().value < value - beside) {
      points.push_back({value - beside, 0, {}});
    } else {
      points.pop_back();
    }
    if (points.empty() || points.back().value < value) points.push_back({value, 1, {}});
    points.push_back({value + beside, 0, {}});
  }
  return TransferFunction(std::move(points));
}

std::vector<SlicePosition> slice_positions(const std::vector<Slice>& slices,
                                           const Ray<double>& ray) {
  std::vector<SlicePosition> result;
  for (const Slice& slice : slices) {
    const Vec3<double> n = unit(slice.normal);
    const auto toward = [&](const auto& of) {
      return static_cast<long double>(n.x) * of.x + static_cast<long double>(n.y) * of.y +
             static_cast<long double>(n.z) * of.z;
    };
    const long double slope = toward(ray.direction);
    const long double away = toward(slice.point) - toward(ray.origin);
    const long double t = away / slope;
    const double sizes = length(slice.point) + length(ray.origin);
    SlicePosition position{std::numeric_limits<double>::infinity(), 0};
    if (std::abs(slope) < 1e-9L) {
      position.along = std::abs(away) <= 1e-8L * sizes;
    } else if (std::isfinite(t) && t >= 0) {
      position.t = static_cast<double>(t);
      position.error =
          8 * rounding_unit<double> * (sizes + position.t) / static_cast<double>(std::abs(slope));
    }
    result.push_back(position);
  }
  return result;
}

std::vector<LightSource<double>> light_sources(const std::vector<Light>& lights) {
  std::vector<LightSource<double>> result;
  for (const Light& light : lights) {
    LightSource<double> source;
    source.color = light.color;
    if (const auto* directional = std::get_if<DirectionalLight>(&light.kind)) {
      source.kind = LightSource<double>::Kind::directional;
      source.place = -unit(directional->direction);
    } else if (const auto* point = std::get_if<PointLight>(&light.kind)) {
      source.kind = LightSource<double>::Kind::point;
      source.place = point->position;
    }
    result.push_back(source);
  }
  return result;
}

}  // namespace pellucid
