// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <list>
#include <memory>
#include <mutex>

#include "layer_setup.h"
#include "pellucid/scene/scene.h"

namespace pellucid {

/// The set-ups of layers that are kept from frame to frame, found by what they show: the same
/// objects in the same place, with the same setting. Safe to use from any thread.
class LayerSetups {
 public:
  /// Returns the set-up of a layer, a kept one where there is one.
  std::shared_ptr<const LayerSetup> find(const Layer& layer, const LayerSetting& setting,
                                         int threads);
  /// Lets go of all that shows no layer of the scene, visible or not, and of all but the last
  /// `most_of_layer` of each.
  void keep_only(const Scene& scene);
  void clear();

 private:
  static constexpr int most_of_layer = 2;

  std::mutex mutex_;
  std::list<std::shared_ptr<const LayerSetup>> kept_;  ///< the last one used first
};

}  // namespace pellucid
