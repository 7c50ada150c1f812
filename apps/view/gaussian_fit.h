// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "pellucid/io/scene_json.h"

namespace pellucid::view {

/// Suggests Gaussians for a layer (suggest_gaussians()) on a thread of its own, which ends with
/// this object.
class GaussianFit {
 public:
  /// The function, or why there is none; neither if it was cancelled.
  struct Outcome {
    std::optional<MultivariateDescription> function;
    std::string error;
  };
  /// Both are called by the other thread: with the fraction of the work that is done, a few times,
  /// and once at the end, after which nothing is called.
  using Progress = std::function<void(double fraction)>;
  using Done = std::function<void(Outcome)>;

  GaussianFit(LayerDescription layer, Layer loaded, ParallelFor parallel, Progress progress,
              Done done);

  /// Makes it end soon. Safe to call from any thread.
  void cancel() { thread_.request_stop(); }

 private:
  std::jthread thread_;
};

}  // namespace pellucid::view
