// SPDX-License-Identifier: Apache-2.0
#include "suggestions.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "pellucid/scene/error.h"
#include "pellucid/scene/suggest.h"

namespace pellucid::view {

MultivariateDescription suggest_gaussians(const LayerDescription& layer,
                                          const ParallelFor& parallel, const Layer* loaded) {
  if (layer.mesh || layer.labels) {
    throw Error(
        "Gaussians are suggested for volumes; give a mesh a function of its arrays by --tf");
  }
  std::vector<ChannelSource> sources = layer.channels;
  const bool is_field = sources.empty();
  if (is_field) {
    const std::string value(field_channel);
    const auto kind = DerivedSource::Kind::gradient_magnitude;
    sources = {{value, "", layer.field},
               {std::string(derived_name(kind)), "", DerivedSource{kind, value, 0}}};
  }
  const Channels channels = load_channels(
      sources, parallel, loaded != nullptr ? loaded_channels(*loaded) : std::vector<Channel>());
  std::vector<int> which(
      static_cast<std::size_t>(std::min(channels.count(), max_suggested_channels)));
  std::iota(which.begin(), which.end(), 0);
  const std::vector<GaussianPrimitive> primitives =
      is_field ? suggest_boundaries(channels, 0, 1, parallel)
               : suggest_mixture(channels, which, 0, parallel);
  MultivariateDescription function;
  for (const int channel : which) function.channels.push_back(channels[channel].name);
  for (const GaussianPrimitive& primitive : primitives) {
    function.gaussians.push_back({function.channels, primitive.center,
                                  GaussianMatrix{primitive.matrix}, primitive.extinction,
                                  primitive.color});
  }
  return function;
}

void suggest_missing_functions(SceneDescription& description, const ParallelFor& parallel) {
  for (LayerDescription& layer : description.layers) {
    const bool is_open = !layer.channels.empty() && !layer.mesh && !layer.labels &&
                         !layer.transfer_function && layer.isosurfaces.empty() &&
                         layer.slices.empty();
    if (is_open) layer.transfer_function = suggest_gaussians(layer, parallel);
  }
}

}  // namespace pellucid::view
