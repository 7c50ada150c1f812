// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/packet/bundle/culled_mixture.h"

namespace pellucid {

/// Parts of a transfer function that rays in lanes look at before they integrate.
class NearMixtureStorage {
 public:
  NearMixtureStorage() = default;
  /// `opacity`: how much of Gaussians may be passed over on a ray, of which none is longer in the
  /// mesh than the diagonal.
  /// `largest`: magnitude of each channel's data. `off`: as much may be what errors of the data
  /// make of the extinction, where they make any.
  NearMixtureStorage(const double* largest, bool off, const MultivariateTransfer<double>& transfer,
                     double opacity, double diagonal);

  /// Returns whether binary32 has its numbers.
  bool suits_packets() const noexcept { return suits_packets_; }

  /// Returns a view of this object, valid while it is not moved.
  const CulledMixture& view() noexcept {
    mixture_.primitive = near_.data();
    return mixture_;
  }

 private:
  CulledMixture mixture_;
  std::vector<NearGaussian> near_;
  bool suits_packets_ = true;
};

}  // namespace pellucid
