// SPDX-License-Identifier: Apache-2.0
#include "suggestions.h"

#include <algorithm>
#include <exception>
#include <memory>
#include <new>
#include <numeric>
#include <string>
#include <utility>

#include "gaussian_fit.h"
#include "pellucid/scene/error.h"

namespace pellucid::view {

MultivariateDescription suggest_gaussians(const LayerDescription& layer,
                                          const ParallelFor& parallel, const Layer* loaded,
                                          const SuggestControl& control) {
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
  MultivariateDescription function;
  function.gaussians = is_field ? suggest_boundaries(channels, 0, 1, parallel, control)
                                : suggest_mixture(channels, which, 0, parallel, control);
  for (const int channel : which) function.channels.push_back(channels[channel].name);
  for (GaussianPrimitive& primitive : function.gaussians) {
    primitive.channels.assign(function.channels.begin(), function.channels.end());
  }
  return function;
}

std::vector<std::optional<Layer>> suggest_missing_functions(
    SceneDescription& description, const ParallelFor& parallel,
    const std::function<void(std::vector<ChannelSource>&)>& before_reading) {
  std::vector<std::optional<Layer>> loaded(description.layers.size());
  for (std::size_t i = 0; i < description.layers.size(); ++i) {
    LayerDescription& layer = description.layers[i];
    const bool is_open = !layer.channels.empty() && !layer.mesh && !layer.labels &&
                         !layer.transfer_function && layer.isosurfaces.empty() &&
                         layer.slices.empty();
    if (!is_open) continue;
    std::vector<ChannelSource> sources = layer.channels;
    before_reading(sources);
    ChannelsContent content;
    content.channels = std::make_shared<const Channels>(load_channels(sources, parallel));
    loaded[i].emplace().content = std::move(content);
    layer.transfer_function = suggest_gaussians(layer, parallel, &*loaded[i], {true, {}});
  }
  return loaded;
}

GaussianFit::Outcome fit_outcome(const LayerDescription& layer, const Layer& loaded,
                                 const ParallelFor& parallel, const SuggestControl& control) {
  try {
    return {suggest_gaussians(layer, parallel, &loaded, control), {}};
  } catch (const FitCancelled&) {
    return {};
  } catch (const std::bad_alloc&) {
    return {{}, "there is not enough memory to fit Gaussians"};
  } catch (const std::exception& error) {
    return {{}, error.what()};
  }
}

}  // namespace pellucid::view
