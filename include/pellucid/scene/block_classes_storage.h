// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/render/transfer_tables.h"
#include "pellucid/scene/volume.h"
#include "pellucid/traverse/block_classes.h"

namespace pellucid {

/// Makes and owns the classes of a volume's blocks under one transfer function: once a frame, from
/// the blocks' records alone, each in a time that does not depend on how many control points the
/// function has.
class BlockClassesStorage {
 public:
  BlockClassesStorage() = default;
  /// `largest_color`: that of RayTolerance. In parallel where it is told how.
  /// `most_bending`: blocks are smooth only where SmoothBlocks::roughness times what the data bend
  /// over a cell is no more than that; 0: none is.
  BlockClassesStorage(const BlockRecords& records, const TransferTables& transfer,
                      double largest_color, const ParallelFor& parallel = {},
                      double most_bending = 0);

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
