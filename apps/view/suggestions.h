// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/io/scene_json.h"

namespace pellucid::view {

/// Returns a first function of Gaussians for a layer: of a field by value and gradient magnitude,
/// of channels by the first two or three of them (scene/suggest.h). Reads data that `loaded`, the
/// layer as it was made, does not have. Throws Error for meshes and labels.
MultivariateDescription suggest_gaussians(const LayerDescription& layer,
                                          const ParallelFor& parallel,
                                          const Layer* loaded = nullptr);
/// Gives each layer of several channels that has neither a function nor a surface a suggested one.
void suggest_missing_functions(SceneDescription& description, const ParallelFor& parallel);

}  // namespace pellucid::view
