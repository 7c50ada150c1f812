// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/field/multichannel_grid.h"
#include "pellucid/scene/channels.h"
#include "pellucid/scene/multivariate_transfer_function.h"
#include "pellucid/traverse/multivariate_blocks.h"

namespace pellucid {

/// Makes and owns what a multivariate transfer function does in the blocks of its channels: once a
/// frame, from the blocks' ranges alone. 12 bytes a block of 8³ cells, 16 with what is smooth.
class MultivariateBlocksStorage {
 public:
  MultivariateBlocksStorage() = default;
  /// A primitive is left out of a block where it, with all that are left out there, stays below
  /// `negligible` (extinction, > 0) whatever the data are in the box of the channels' ranges; a
  /// block where no primitive is left and no table absorbs is skipped. In parallel where it is told
  /// how. `channels` must outlive the views.
  MultivariateBlocksStorage(const Channels& channels,
                            const MultivariateTransferFunction& transfer_function,
                            double negligible, const ParallelFor& parallel = {});

  /// Finds out which blocks are smooth, for the channels and the function that this was made of.
  void find_smooth(const Channels& channels, const MultivariateTransferFunction& transfer_function,
                   const ParallelFor& parallel = {});

  MultivariateBlocks view() const noexcept {
    return {records_, {classes_.data()}, primitives_.data(), negligible_};
  }
  /// None is before find_smooth().
  SmoothChannels smooth() const noexcept { return {waves_.data(), longest_step_}; }

 private:
  BlockRecords records_;
  std::vector<BlockClass> classes_;
  std::vector<PrimitiveSet> primitives_;
  double negligible_ = 0;
  std::vector<float> waves_;
  double longest_step_ = 0;
};

/// The fields of the channels as kernels see them. `channels` must outlive the view.
MultichannelGrid multichannel_grid(const Channels& channels);

}  // namespace pellucid
