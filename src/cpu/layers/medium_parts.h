// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "layer_merge.h"
#include "layer_mixture.h"
#include "lit_parts.h"

namespace pellucid {

class MultivariateRayIntegrator;

/// Has a MultivariateRayIntegrator integrate the layers that are present on a part of a ray: one
/// function of all of their channels (layer_mixture.h), a sum of terms; where any of them has light
/// or a factor of its extinction, lit panels take its place (lit_parts.h). Used by one thread.
class MediumParts {
 public:
  /// Both must outlive the object.
  MediumParts(const std::vector<const LayerSource*>& sources,
              const std::vector<LightSource<double>>& lights)
      : sources_(sources), parts_(lights), mixtures_(sources) {}

  /// `key`: LayerMerge::key(); `stretches`: of each layer that is present, the one that holds the
  /// part. Returns false if there are more channels or Gaussians than the integrator takes: nobody
  /// knows what comes behind.
  bool add(const MergedPart& part, const std::vector<int>& key,
           const std::vector<const LayerStretch*>& stretches, const Ray<double>& ray,
           MultivariateRayIntegrator& integrator);

 private:
  bool add_unlit(const MergedPart& part, const std::vector<int>& key,
                 const std::vector<const LayerStretch*>& stretches,
                 MultivariateRayIntegrator& integrator);
  const MultivariateTransfer<double>& function(std::size_t layer, int number) const {
    return sources_[layer]->functions()[static_cast<std::size_t>(number)];
  }

  const std::vector<const LayerSource*>& sources_;
  LitParts parts_;
  LayerMixtureCache mixtures_;
  const LayerMixture* mixture_ = nullptr;  ///< of the last part without light
  LayerMixture::Span span_;
};

}  // namespace pellucid
