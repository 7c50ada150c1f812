// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/packet/mesh_mixture.h"
#include "pellucid/scene/mesh_channels.h"

namespace pellucid {

/// What rays in lanes look at of a transfer function before they integrate.
class MeshMixtureStorage {
 public:
  MeshMixtureStorage() = default;
  /// `opacity`: how much of Gaussians may be passed over on a ray, of which none is longer in the
  /// mesh than the diagonal.
  MeshMixtureStorage(const MeshChannels& channels, const Multivariate<double>& transfer,
                     double opacity, double diagonal);

  /// Whether binary32 has its numbers.
  bool suits_packets() const noexcept { return suits_packets_; }

  /// Of this object while it stays where it is.
  const MeshMixture& view() noexcept {
    mixture_.primitive = near_.data();
    return mixture_;
  }

 private:
  MeshMixture mixture_;
  std::vector<NearGaussian> near_;
  bool suits_packets_ = true;
};

}  // namespace pellucid
