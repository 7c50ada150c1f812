// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "pellucid/io/scene_json.h"
#include "pellucid/scene/suggest.h"

namespace pellucid::view {

/// Returns a first function of Gaussians for a layer: of a field by value and gradient magnitude,
/// of channels by the first two or three of them (scene/suggest.h). Reads data that `loaded`, the
/// layer as it was made, does not have. Throws Error for meshes and labels, and what
/// `control.progress` throws.
MultivariateDescription suggest_gaussians(const LayerDescription& layer,
                                          const ParallelFor& parallel,
                                          const Layer* loaded = nullptr,
                                          const SuggestControl& control = {});

/// Gives each layer of several channels that has neither a function nor a surface a quickly
/// suggested one. Returns the layers with the data that were read for it, for remake_scene(); none
/// of other layers. `before_reading` is called with what is read for each of them.
std::vector<std::optional<Layer>> suggest_missing_functions(
    SceneDescription& description, const ParallelFor& parallel,
    const std::function<void(std::vector<ChannelSource>&)>& before_reading);

}  // namespace pellucid::view
