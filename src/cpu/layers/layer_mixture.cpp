// SPDX-License-Identifier: Apache-2.0
#include "layer_mixture.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace pellucid {

LayerMixture::LayerMixture(const std::vector<const LayerSource*>& sources, std::vector<int> key)
    : key_(std::move(key)), first_channel_(key_.size()), primitives_(key_.size()) {
  int channels = 0;
  for (std::size_t layer = 0; layer < key_.size(); ++layer) {
    if (key_[layer] < 0) continue;
    const MultivariateTransfer<double>& own =
        sources[layer]->functions()[static_cast<std::size_t>(key_[layer])];
    first_channel_[layer] = channels;
    primitives_[layer] = {static_cast<int>(gaussians_.size()), own.gaussians.count};
    for (int i = 0; i < own.gaussians.count; ++i) {
      gaussians_.push_back(own.gaussians.primitive[i]);
      gaussians_.back().first += channels;
    }
    for (int i = 0; i < own.tables; ++i) {
      tables_.push_back(own.table[i]);
      tables_.back().channel += channels;
    }
    channels += own.channels;
  }
  fits_ = channels <= max_bundle_channels && gaussians_.size() <= std::size_t{max_gaussians};
  transfer_.gaussians = {gaussians_.data(), static_cast<int>(gaussians_.size())};
  transfer_.table = tables_.data();
  transfer_.tables = static_cast<int>(tables_.size());
  transfer_.channels = channels;
}

PrimitiveSet LayerMixture::primitives(std::size_t layer, PrimitiveSet of_layer) const noexcept {
  const auto [first, count] = primitives_[layer];
  unsigned long long bits = of_layer.bits;
  if (count < 64) bits &= (1ULL << count) - 1;
  // Bit i mod 64 represents primitive i, here and there.
  return {std::rotl(bits, first & 63)};
}

const LayerMixture& LayerMixtureCache::find(const std::vector<int>& key) {
  const auto found = std::ranges::find_if(
      mixtures_,
      [&](const std::unique_ptr<const LayerMixture>& mixture) { return mixture->key() == key; });
  if (found != mixtures_.end()) {
    // Rays see the same few again and again.
    std::iter_swap(mixtures_.begin(), found);
    return *mixtures_.front();
  }
  mixtures_.push_back(std::make_unique<const LayerMixture>(sources_, key));
  return *mixtures_.back();
}

}  // namespace pellucid
