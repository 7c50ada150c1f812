// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "pellucid/render/transfer_tables.h"
#include "pellucid/scene/volume.h"
#include "pellucid/traverse/block_classes.h"

namespace pellucid {

/// How rays may go through smooth blocks in steps: how many lengths these have
/// (SmoothBlocks::levels), and what blocks may bend to be worth a try then, SmoothBlocks::roughness
/// times what the data bend over a cell.
struct StepLimits {
  int levels = 0;
  double max_second_difference = 0;
};

/// Makes and owns the classes of a volume's blocks under one transfer function: once a frame, from
/// the blocks' records alone, each in a time that does not depend on how many control points the
/// function has.
class BlockClassesStorage {
 public:
  BlockClassesStorage() = default;
  /// `largest_color`: that of RayTolerance. In parallel where it is told how.
  /// `limits`: of smooth blocks, given the share of those that might be smooth in which all values
  /// absorb; without it none is smooth.
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
