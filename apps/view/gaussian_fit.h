// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "pellucid/io/scene_json.h"
#include "pellucid/scene/suggest.h"

namespace pellucid::view {

/// Suggests Gaussians for a layer (suggest_gaussians()) on a thread of its own, which ends with
/// this object; in a page, which has none, before the constructor returns.
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
  ~GaussianFit();
  GaussianFit(const GaussianFit&) = delete;
  GaussianFit& operator=(const GaussianFit&) = delete;

  /// Makes it end soon. Safe to call from any thread.
  void cancel();

 private:
  struct Thread;
  std::unique_ptr<Thread> thread_;
};

/// Returns the function or why there is none. `control` may throw FitCancelled.
GaussianFit::Outcome fit_outcome(const LayerDescription& layer, const Layer& loaded,
                                 const ParallelFor& parallel, const SuggestControl& control);
struct FitCancelled {};

}  // namespace pellucid::view
