// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "layer_stream.h"
#include "pellucid/segment/multivariate_span.h"

namespace pellucid {

/// The layers that are present on a stretch of a ray, as one transfer function: a mixture, whose
/// terms are those of all of them.
class LayerMixture {
 public:
  using Span = MultivariateSpan<double, CubicBernstein<double>, max_bundle_channels>;

  /// `key`: for each layer the function of its source, or -1 where it is absent.
  LayerMixture(const std::vector<const LayerSource*>& sources, std::vector<int> key);
  // The function points into the object.
  LayerMixture(const LayerMixture&) = delete;
  LayerMixture& operator=(const LayerMixture&) = delete;

  const std::vector<int>& key() const noexcept { return key_; }
  const MultivariateTransfer<double>& transfer() const noexcept { return transfer_; }
  /// Returns whether a span has room for the channels of all layers, and a panel for the Gaussians.
  bool fits() const noexcept { return fits_; }
  /// Returns the first channel of a layer that is present.
  int first_channel(std::size_t layer) const noexcept { return first_channel_[layer]; }
  /// Returns the mixture's set of the primitives that a layer's set has.
  PrimitiveSet primitives(std::size_t layer, PrimitiveSet of_layer) const noexcept;

 private:
  struct Primitives {
    int first = 0, count = 0;
  };

  std::vector<int> key_;
  std::vector<int> first_channel_;
  std::vector<Primitives> primitives_;
  std::vector<Gaussian<double>> gaussians_;
  std::vector<ChannelTable<double>> tables_;
  MultivariateTransfer<double> transfer_;
  bool fits_ = true;
};

/// The mixtures that rays have met so far. Used by one thread.
class LayerMixtureCache {
 public:
  explicit LayerMixtureCache(const std::vector<const LayerSource*>& sources) : sources_(sources) {}

  /// Returns the mixture of a key, valid while this object lives.
  const LayerMixture& find(const std::vector<int>& key);

 private:
  const std::vector<const LayerSource*>& sources_;
  std::vector<std::unique_ptr<const LayerMixture>> mixtures_;
};

}  // namespace pellucid
