// SPDX-License-Identifier: Apache-2.0
#include "medium_parts.h"

#include "pellucid/render/multivariate_integrator.h"

namespace pellucid {

bool MediumParts::add(const MergedPart& part, const std::vector<int>& key,
                      const std::vector<const LayerStretch*>& stretches, const Ray<double>& ray,
                      MultivariateRayIntegrator& integrator) {
  if (!part.lit) return add_unlit(part, key, stretches, integrator);
  parts_.start(ray, part.range);
  for (std::size_t i = 0; i < key.size(); ++i) {
    if (key[i] >= 0) parts_.add(*stretches[i], function(i, key[i]), sources_[i]->look());
  }
  parts_.finish();
  parts_.integrate(part.left_out, part.position_error, integrator);
  return true;
}

bool MediumParts::add_unlit(const MergedPart& part, const std::vector<int>& key,
                            const std::vector<const LayerStretch*>& stretches,
                            MultivariateRayIntegrator& integrator) {
  if (mixture_ == nullptr || mixture_->key() != key) mixture_ = &mixtures_.find(key);
  if (!mixture_->fits()) {
    integrator.charge_opacity(1);
    return false;
  }
  PrimitiveSet primitives{0};
  for (std::size_t i = 0; i < key.size(); ++i) {
    if (key[i] < 0) continue;
    CubicBernstein<double>* const to = span_.data + mixture_->first_channel(i);
    for (int c = 0; c < function(i, key[i]).channels; ++c) {
      to[c] = channel_on(*stretches[i], c, part.range);
    }
    primitives.bits |= mixture_->primitives(i, stretches[i]->primitives).bits;
  }
  span_.length = part.range.end - part.range.begin;
  integrator.set_transfer(mixture_->transfer());
  integrator.add_stretch(span_, part.range, primitives, part.left_out, part.position_error);
  return true;
}

}  // namespace pellucid
