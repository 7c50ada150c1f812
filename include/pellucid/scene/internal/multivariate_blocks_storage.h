// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/field/multichannel_grid.h"
#include "pellucid/scene/channels.h"
#include "pellucid/scene/multivariate_transfer_function.h"
#include "pellucid/traverse/multivariate_blocks.h"

namespace pellucid {

/// Builds and owns, for each block of the channels, the primitives of a multivariate transfer
/// function that matter there. It is built once per frame from the block ranges alone: 12 bytes per
/// block of 8³ cells, 16 with the smoothness of the block.
class MultivariateBlocksStorage {
 public:
  MultivariateBlocksStorage() = default;
  /// Classifies all blocks, in parallel if `parallel` is given. `channels` must outlive the views.
  ///
  /// A primitive is left out of a block if it and all others left out there together stay below
  /// `negligible` (an extinction > 0) for all data in the box of the channels' ranges. A block
  /// without primitives and without an absorbing table is skipped.
  MultivariateBlocksStorage(const Channels& channels,
                            const MultivariateTransferFunction& transfer_function,
                            double negligible, const ParallelFor& parallel = {});

  /// Finds the smooth blocks, for the same channels and function that this object was made from.
  void find_smooth(const Channels& channels, const MultivariateTransferFunction& transfer_function,
                   const ParallelFor& parallel = {});

  MultivariateBlocks view() const noexcept {
    return {records_, {classes_.data()}, primitives_.data(), negligible_};
  }
  /// Returns the smooth blocks; there are none before find_smooth().
  SmoothChannels smooth() const noexcept { return {waves_.data(), longest_step_}; }

 private:
  BlockRecords records_;
  std::vector<BlockClass> classes_;
  std::vector<PrimitiveSet> primitives_;
  double negligible_ = 0;
  std::vector<float> waves_;
  double longest_step_ = 0;
};

/// Returns the fields of the channels as kernels use them. `channels` must outlive the view.
MultichannelGrid multichannel_grid(const Channels& channels);

}  // namespace pellucid
