// SPDX-License-Identifier: Apache-2.0
#include "layer_setups.h"

#include <algorithm>
#include <vector>

namespace pellucid {

std::shared_ptr<const LayerSetup> LayerSetups::find(const Layer& layer, const LayerSetting& setting,
                                                    int threads) {
  {
    const std::lock_guard lock(mutex_);
    const auto found = std::ranges::find_if(kept_, [&](const auto& setup) {
      return setup->setting() == setting && setup->shows(layer);
    });
    if (found != kept_.end()) {
      kept_.splice(kept_.begin(), kept_, found);
      return kept_.front();
    }
  }
  // Other frames need not wait for it; at worst, two of them make the same.
  auto made = std::make_shared<const LayerSetup>(layer, setting, threads);
  const std::lock_guard lock(mutex_);
  kept_.push_front(made);
  return made;
}

void LayerSetups::keep_only(const Scene& scene) {
  const std::lock_guard lock(mutex_);
  std::vector<int> of_layer(scene.layers.size(), 0);
  std::erase_if(kept_, [&](const auto& setup) {
    for (std::size_t i = 0; i < scene.layers.size(); ++i) {
      if (setup->shows(scene.layers[i])) return ++of_layer[i] > most_of_layer;
    }
    return true;
  });
}

void LayerSetups::clear() {
  const std::lock_guard lock(mutex_);
  kept_.clear();
}

}  // namespace pellucid
