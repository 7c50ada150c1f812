// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "pellucid/scene/layer.h"

namespace pellucid::reference {

/// Quantities that light needs beside the values of the data. Its chords follow those of the
/// channels, in this order.
struct DerivedChannels {
  std::optional<int> gradient_of{};  ///< three chords: the gradient in the world
  GradientKind kind = GradientKind::smooth;
  std::optional<int> magnitude_of{};  ///< one: the magnitude of the smooth gradient

  DerivedChannels() = default;
  explicit DerivedChannels(const Layer& layer) {
    if (layer.shading) {
      gradient_of = layer.shading->channel;
      kind = layer.shading->gradient;
    }
    if (layer.gradient_opacity) magnitude_of = layer.gradient_opacity->channel();
  }

  /// Return the index of the first of these chords; `channels` is the number of channels.
  std::size_t gradient(std::size_t channels) const { return channels; }
  std::size_t magnitude(std::size_t channels) const { return channels + (gradient_of ? 3 : 0); }
};

}  // namespace pellucid::reference
