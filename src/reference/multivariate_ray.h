// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "grid.h"
#include "mixture.h"
#include "pellucid/reference/render.h"

namespace pellucid::reference {

/// The volume rendering integral through several channels on one grid, that of the first. Views of
/// what it is made from.
class MultivariateIntegral {
 public:
  MultivariateIntegral(const Channels& channels, const MultivariateTransferFunction& function);

  /// Along a ray with a direction of length 1. Adds the number of cells crossed to `cells`.
  ReferencePixel operator()(const RealRay& ray, bool with_depth, std::uint64_t& cells) const;

 private:
  /// A chord for each channel; none where a corner is NaN in any of them.
  std::vector<Chord> chords(const Crossing& crossing) const;

  std::vector<Grid> grids_;
  Mixture mixture_;
};

}  // namespace pellucid::reference
