// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "command.h"
#include "pellucid/cpu/renderer.h"
#include "pellucid/scene/scene.h"

namespace pellucid::view {

/// Data that the ray through a position of the picture meets.
struct ProbeResult {
  double opacity = 0;
  double optical_depth = 0;  ///< infinite where nothing behind is seen
  /// Position at which half of the opacity is reached; none if the ray meets nothing.
  std::optional<Vec3<double>> position;
  /// One for each channel of a visible layer that has data there.
  struct Value {
    std::size_t layer;
    std::string channel;
    double value;
  };
  std::vector<Value> values{};
  /// The layer that absorbs most at the position; none if none does.
  std::optional<std::size_t> layer{};
};

/// Renders the ray and looks the values up.
ProbeResult probe(Renderer& renderer, const Scene& scene, const Probe& at);
/// Returns the message for a page.
Json probe_json(const ProbeResult& result, const Probe& at);

}  // namespace pellucid::view
