// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "pellucid/render/transfer_tables.h"
#include "pellucid/scene/volume.h"
#include "pellucid/traverse/block_classes.h"

namespace pellucid {

/// Limits of the step lengths that rays may take through smooth blocks.
struct StepLimits {
  int levels = 0;                    ///< number of step lengths (SmoothBlocks::levels)
  double max_second_difference = 0;  ///< largest SmoothBlocks::roughness, times the data's second
                                     ///< difference over a cell, of a block that is tried
};

/// Builds and owns the classes of a volume's blocks under one transfer function. It is built once
/// per frame from the block records alone; the time per block does not depend on the number of
/// control points.
class BlockClassesStorage {
 public:
  BlockClassesStorage() = default;
  /// Classifies all blocks, in parallel if `parallel` is given. `largest_color` is
  /// RayTolerance::largest_color. `limits` maps the fraction of candidate blocks in which all
  /// values absorb to the step limits; without it no block is smooth.
  BlockClassesStorage(const BlockRecords& records, const TransferTables& transfer,
                      double largest_color, const ParallelFor& parallel = {},
                      const std::function<StepLimits(double)>& limits = {});

  BlockClasses view() const noexcept { return {classes_.data()}; }
  SmoothBlocks smooth() const noexcept {
    SmoothBlocks smooth = smooth_;
    smooth.local = local_.data();
    return smooth;
  }

 private:
  std::vector<BlockClass> classes_;
  SmoothBlocks smooth_;
  std::vector<float> local_;
};

}  // namespace pellucid
