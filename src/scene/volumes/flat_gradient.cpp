// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstddef>
#include <variant>

#include "layer_light.h"
#include "pellucid/scene/internal/value_noise.h"
#include "pellucid/scene/layer.h"

namespace pellucid {
namespace {

double range_of(const Layer& layer) {
  if (const auto* source = std::get_if<SourceContent>(&layer.content)) {
    const auto channel = static_cast<std::size_t>(layer.shading->channel);
    const StretchSource::Variable& variable = source->source->description().variables[channel];
    return variable.maximum - variable.minimum;
  }
  const Volume* const volume = lit_volume(layer);
  const VolumeStatistics& data =
      volume != nullptr
          ? volume->statistics()
          : std::get<MeshContent>(layer.content).mesh->statistics(layer.shading->channel);
  return data.maximum - data.minimum;
}

/// Returns the mean side of the data's box.
double side_of(const Layer& layer) {
  const std::array<Vec3<double>, 8> corners = world_corners(layer);
  double sum = 0;
  for (const unsigned a : {1U, 2U, 4U}) sum += length(corners[a] - corners[0]);
  return sum / 3;
}

}  // namespace

const Volume* lit_volume(const Layer& layer) noexcept {
  if (const auto* channels = std::get_if<ChannelsContent>(&layer.content)) {
    return (*channels->channels)[layer.shading->channel].volume.get();
  }
  return grid_of(layer);
}

double flat_gradient_of_surfaces(const Layer& layer) noexcept {
  const auto& flatness = layer.shading->flatness;
  return flatness ? *flatness * range_of(layer) / voxel_of(layer) : 0;
}

double flat_gradient(const Layer& layer) {
  if (layer.shading->flat_gradient) return *layer.shading->flat_gradient;
  if (layer.shading->flatness) return flat_gradient_of_surfaces(layer);
  const Volume* const volume = lit_volume(layer);
  return volume != nullptr ? flat_gradient(layer, volume->noise(), side_of(layer))
                           : least_flat_gradient(range_of(layer), side_of(layer));
}

double least_flat_gradient(double range, double side) noexcept {
  return side > 0 ? range / side / 50 : 0;
}

double flat_gradient(const Layer& layer, const ValueNoise& noise, double side) {
  const double voxel = voxel_of(layer);
  const double least = least_flat_gradient(noise.upper() - noise.lower(), side);
  if (!(voxel > 0)) return least;
  const TypicalNoise found = noise.where_absorbs(table_of(layer));
  return std::max(std::min(2.5 * found.deviation, found.gradient / 4) / voxel, least);
}

}  // namespace pellucid
