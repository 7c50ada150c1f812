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
  BlockClassesStorage(const BlockRecords& records, const TransferTables& transfer,
                      double largest_color, const ParallelFor& parallel = {});

  BlockClasses view() const noexcept { return {classes_.data()}; }

 private:
  std::vector<BlockClass> classes_;
};

}  // namespace pellucid
